"""Rows of the tables of results. The names of the attributes are those of the columns."""

from __future__ import annotations

from ._attributes import _QUANTITIES, Column, Row, T


class Recorded(Column[T]):
    """A column of a study, which has the unit and the meaning of the recorded quantity."""

    def __set_name__(self, owner: type, name: str) -> None:
        super().__set_name__(owner, name)
        self.describe(*_QUANTITIES[name])


class PreloadOnAxis(Column[T]):
    """The column `preload` of a study, whose unit depends on the axis."""

    def __set_name__(self, owner: type, name: str) -> None:
        super().__set_name__(owner, name)
        self.describe("", "preload: in units of E* h L on the axis `preload`, in N on the axis `preload_in_N`")


class CurvePoint(Row):
    """A point of a force curve."""

    stage = Column[int]()
    indentation = Column[float]()
    force = Column[float]()
    contact_length = Column[float]()
    patches = Column[int]()
    stored_energy = Column[float]()
    displacement = Column[float]()


class Event(Row):
    """A jump of the contact or a mark of the figure. A mark without a jump has None for what a jump has."""

    stage = Column[int]()
    time = Column[float | None]()
    indentation = Column[float]()
    mark = Column[str]()
    event = Column[str]()
    energy = Column[float | None]()
    springs = Column[int | None]()
    force_before = Column[float | None]()
    force_after = Column[float | None]()
    patches_before = Column[int | None]()
    patches_after = Column[int | None]()
    patch = Column[int | None]()
    first_before = Column[int | None]()
    last_before = Column[int | None]()
    first_after = Column[int | None]()
    last_after = Column[int | None]()
    jumps_to = Column[float | None]()
    instrument_loss = Column[float | None]()


class ProfileResults(Row):
    """Results of a scene on one random profile."""

    seed = Column[int]()
    pull_off_force = Column[float | None]()
    adhesion_share = Column[float | None]()
    first_touch_pull_off_force = Column[float | None]()
    zero_force_pull_off_force = Column[float | None]()
    dissipated_energy = Column[float | None]()
    regime = Column[str | None]()
    regime_after_zero_force = Column[str | None]()
    preload_indentation = Column[float | None]()
    contact_fraction = Column[float | None]()
    skewness = Column[float | None]()
    excess_kurtosis = Column[float | None]()
    tabor_number = Column[float | None]()


class PreloadResults(Row):
    """Results of a profile after one preload."""

    preload = Column[float]()
    preload_indentation = Column[float | None]()
    pull_off_force = Column[float | None]()
    pull_off_indentation = Column[float | None]()
    dissipated_energy = Column[float | None]()


class TurningPoint(Row):
    """A turning point of a loading, and the unloading that begins there."""

    turning_indentation = Column[float]()
    turning_force = Column[float]()
    pull_off_force = Column[float | None]()
    pull_off_indentation = Column[float | None]()
    separation = Column[float | None]()
    dissipated_energy = Column[float | None]()


class StudyRecord(Row):
    """A record of a study: one combination of values on one profile. It has the quantities that the study records.

    `record["adhesion.kappa"]` is the value on an axis, by the path of its field.
    """

    cell = Column[int]()
    seed = Column[int]()
    preload = PreloadOnAxis[float | None]()
    reason = Column[str]()
    kappa = Recorded[float | None]()
    elastic_energy = Recorded[float | None]()
    elastic_energy_ratio = Recorded[float | None]()
    work = Recorded[float | None]()
    ideal_pull_off_force = Recorded[float | None]()
    first_touch_pull_off_force = Recorded[float | None]()
    first_touch_adhesion_share = Recorded[float | None]()
    zero_force_pull_off_force = Recorded[float | None]()
    zero_force_adhesion_share = Recorded[float | None]()
    preload_force = Recorded[float | None]()
    preload_indentation = Recorded[float | None]()
    pull_off_force = Recorded[float | None]()
    adhesion_share = Recorded[float | None]()
    adhesion_coefficient = Recorded[float | None]()
    pull_off_indentation = Recorded[float | None]()
    dissipated_energy = Recorded[float | None]()
    tabor_number = Recorded[float | None]()
    contact_fraction = Recorded[float | None]()
    patches = Recorded[int | None]()
    regime = Recorded[str | None]()
    regime_after_zero_force = Recorded[str | None]()
    warnings = Recorded[int | None]()
    stiffness_exponent = Recorded[float | None]()
    force_exponent = Recorded[float | None]()
    rms_height = Recorded[float | None]()
    skewness = Recorded[float | None]()
    excess_kurtosis = Recorded[float | None]()
    summit_height = Recorded[float | None]()


class FittedCurve(Row):
    """Result of the fit to one of several curves: the fitted parameters with their intervals, or the reason why there are none."""

    file = Column[str]()
    work = Column[float | None]()
    work_low = Column[float | None]()
    work_high = Column[float | None]()
    closing_work = Column[float | None]()
    closing_work_low = Column[float | None]()
    closing_work_high = Column[float | None]()
    modulus = Column[float | None]()
    modulus_low = Column[float | None]()
    modulus_high = Column[float | None]()
    offset = Column[float | None]()
    offset_low = Column[float | None]()
    offset_high = Column[float | None]()
    zero = Column[float | None]()
    zero_low = Column[float | None]()
    zero_high = Column[float | None]()
    stiffness = Column[float | None]()
    stiffness_low = Column[float | None]()
    stiffness_high = Column[float | None]()
    radius = Column[float | None]()
    radius_low = Column[float | None]()
    radius_high = Column[float | None]()
    second_radius = Column[float | None]()
    second_radius_low = Column[float | None]()
    second_radius_high = Column[float | None]()
    behind = Column[float | None]()
    behind_low = Column[float | None]()
    behind_high = Column[float | None]()
    relaxation_share = Column[float | None]()
    relaxation_share_low = Column[float | None]()
    relaxation_share_high = Column[float | None]()
    relaxation_time = Column[float | None]()
    relaxation_time_low = Column[float | None]()
    relaxation_time_high = Column[float | None]()
    pull_off_force = Column[float | None]()
    pull_off_work = Column[float | None]()
    residual_over_noise = Column[float | None]()
    residual_over_largest_force = Column[float | None]()
    misfit = Column[float | None]()
    noise = Column[float | None]()
    jumps = Column[int | None]()
    hysteresis = Column[float | None]()
    fall_in_pause = Column[float | None]()
    position_x = Column[float | None]()
    position_y = Column[float | None]()
    points_used = Column[int | None]()
    described = Column[bool | None]()
    description = Column[str]()
    reason = Column[str]()
    warnings = Column[str]()
    error = Column[str]()


class SpectrumBin(Row):
    """Spectrum of a surface in one range of wave numbers."""

    wave_number = Column[float]()
    c2d = Column[float]()
    relative_error = Column[float | None]()
    line = Column[float]()


class ProfileSpectrumBin(Row):
    """Power spectral density of profiles in one range of wave numbers."""

    wave_number = Column[float]()
    power = Column[float]()
    waves = Column[int]()


class SurfaceProfileResults(Row):
    """Results on one random profile with the spectrum of a measured surface."""

    seed = Column[int]()
    pull_off_force = Column[float | None]()
    fit_change = Column[float | None]()
    regime = Column[str | None]()
    regime_after_zero_force = Column[str | None]()
