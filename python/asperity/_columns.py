"""Names of the columns of tables that are not quantities of a study, with their units and meanings."""

from typing import TypeAlias

#: A value in a cell of a table.
Cell: TypeAlias = float | int | str | bool | None

#: Unit and meaning of each name. The unit of a number without a unit is "1", that of a text is empty.
COLUMNS: dict[str, tuple[str, str]] = {
    # Curve of a loop.
    "stage": ("1", "number of the loading stage, counted from 0"),
    "indentation": ("m", "indentation d, 0 at first touch"),
    "force": ("N", "force F, positive in compression"),
    "displacement": ("m", "displacement D = d + F/k of the instrument"),
    "contact_length": ("m", "length of all contact patches"),
    "patches": ("1", "number of contact patches"),
    "stored_energy": ("J", "elastic energy of the springs"),
    # Events of a loop.
    "mark": ("", "mark of the figure, such as jump-in"),
    "time": ("s", "time since first touch, of a body that relaxes"),
    "event": ("", "what happens, such as touches or detaches"),
    "energy": ("J", "elastic energy that springs gain (+) or release (-) at this indentation"),
    "springs": ("1", "number of springs, negative if they detach"),
    "force_before": ("N", "force before the jump"),
    "force_after": ("N", "force after the jump"),
    "patches_before": ("1", "number of patches before the jump"),
    "patches_after": ("1", "number of patches after the jump"),
    "patch": ("1", "number of the patch from the left, counted from 0"),
    "first_before": ("1", "first spring of the patch before the jump"),
    "last_before": ("1", "last spring of the patch before the jump"),
    "first_after": ("1", "first spring of the patch after the jump"),
    "last_after": ("1", "last spring of the patch after the jump"),
    "jumps_to": ("m", "indentation after a jump of the instrument"),
    "instrument_loss": ("J", "energy that is lost in a jump of the instrument"),
    # Profiles and cells.
    "seed": ("1", "seed of the random phases of the profile"),
    "cell": ("1", "number of the combination of values"),
    "reason": ("", "why there are no values; empty if there are"),
    # Preloads and reversals.
    "preload": ("N", "preload F_n"),
    "turning_indentation": ("m", "indentation of the turning point"),
    "turning_force": ("N", "force at the turning point"),
    "separation": ("m", "indentation at which the bodies separate"),
    # Fits of several curves.
    "file": ("", "name of the curve"),
    "work": ("J/m²", "work of adhesion γ"),
    "closing_work": ("J/m²", "work of adhesion γ₁ on closing"),
    "modulus": ("Pa", "effective modulus E*"),
    "offset": ("m", "displacement at first touch"),
    "zero": ("N", "force before contact"),
    "stiffness": ("N/m", "stiffness of the instrument"),
    "radius": ("m", "radius of the sphere"),
    "second_radius": ("m", "radius of the second sphere"),
    "behind": ("m", "distance of the second apex behind the first one"),
    "relaxation_share": ("1", "share of the modulus that relaxes"),
    "relaxation_time": ("s", "relaxation time"),
    "pull_off_work": ("J/m²", "work of adhesion of a smooth sphere with the pull-off force of the curve"),
    "residual_over_noise": ("1", "rms residual in contact divided by the noise"),
    "residual_over_largest_force": ("1", "rms residual in contact divided by the largest force"),
    "misfit": ("1", "robust rms residual in contact divided by the noise; at most 1.5 if the model describes the curve"),
    "noise": ("N", "standard deviation of the noise of the force"),
    "jumps": ("1", "number of jumps of the force"),
    "hysteresis": ("1", "area between loading and unloading divided by the area under the loading"),
    "fall_in_pause": ("1", "largest decrease of the force in a pause divided by the largest force"),
    "position_x": ("m", "place on the specimen"),
    "position_y": ("m", "place on the specimen"),
    "points_used": ("1", "number of points that are used"),
    "described": ("", "whether the model describes the curve within its noise"),
    "description": ("", "how well the model describes the curve"),
    "warnings": ("", "premises of the model that are not met"),
    "error": ("", "why the curve was not fitted; empty if it was"),
    # Spectra.
    "wave_number": ("rad/m", "wave number q"),
    "c2d": ("m⁴", "two-dimensional spectral density of the surface"),
    "relative_error": ("1", "standard error of ln C2D"),
    "line": ("m³", "power spectral density of the equivalent line"),
    "power": ("m³", "mean power spectral density"),
    "waves": ("1", "number of waves averaged"),
    "fit_change": ("N", "change of F_a by a random change of the spectrum within the uncertainty of its fit"),
}
for _name in (
    *("work", "closing_work", "modulus", "offset", "zero", "stiffness", "radius", "second_radius", "behind"),
    *("relaxation_share", "relaxation_time"),
):
    for _end, _meaning in (("low", "lower"), ("high", "upper")):
        COLUMNS[f"{_name}_{_end}"] = (COLUMNS[_name][0], f"{_meaning} end of the 95 % interval")
