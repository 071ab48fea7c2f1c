//! Relaxation in the contact: the springs of the foundation are standard linear solids, so that
//! forces depend on time.
//!
//! # The law
//!
//! The modulus of the foundation falls from E₀ at once to E₀ (1 − s) after a long time: E(t) = E₀
//! (1 − s + s e^(−t/τ)). s is the share and τ the time of the [`Relaxation`](crate::Relaxation).
//! All springs in contact move with the same speed ḋ. A spring with the gap c that attached at the
//! time t₁ with the compression u₁ = d(t₁) − c therefore bears, for each length of the foundation,
//!
//! f = E₀ ((1 − s) (d − c) + s (J + m e^(−t/τ))), with dJ/dt = ḋ − J/τ and m = (u₁ − J(t₁))
//! e^(t₁/τ).
//!
//! J is one number for all springs. m is the *memory* of a spring: one number that is written when
//! the spring attaches and read when it detaches.
//!
//! # The edges
//!
//! The edge of a patch moves faster than the foundation relaxes, so it obeys the instantaneous
//! modulus E₀ (Popov 2025, separation of time scales):
//!
//! * a patch attaches surface that was never in contact as an elastic one does, because free
//!   springs have no memory;
//! * a patch of the length ℓ detaches wherever its tension −f exceeds E₀ Δl(ℓ). Δl is the largest
//!   stretch by the rule of Hess. The quantity e = −f/E₀ is called the *tension* of a spring, in m.
//!   Without relaxation it is the stretch c − d, and the rule is that of an elastic contact. As
//!   there, the place of the largest tension detaches first, be it an edge or inside.
//!
//! # What is not exact
//!
//! * Free springs recover, so that surface which was in contact no longer lies at its gap. Such
//!   surface does not attach again. A loading after springs have detached is refused.
//! * The memory is straight between neighbouring springs. Its kinks deviate by the square of the
//!   spacing.
//! * A remainder of a patch without any spring, between two neighbouring springs, detaches.
//! * The drive moves in steps. The steps are divided until the force deviates by less than a stated
//!   share of the largest force.

mod approach;
pub(crate) mod body;
mod core;
mod course;
mod division;
mod drive;
mod end_patches;
mod field;
pub(crate) mod law;
mod line;
mod loading;
mod memory;
mod patch;
mod peaks;
mod recorder;
mod state;
mod turn;
mod view;
