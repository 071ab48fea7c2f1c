//! One work of adhesion from many curves of a rough body whose profile is unknown. The curves are
//! compared with curves computed for random profiles of the spectrum of the scene.
//!
//! Each measured curve becomes a few numbers, its summaries ([`summary`], [`measured`]). Curves of
//! random profiles ([`computed`]) have summaries at all nodes of a table ([`place`], [`table`]).
//! From the table polynomials are learned that predict the parameters ([`learn`]), and their mean
//! and scatter over all profiles ([`scatter`]). The mean over the measured curves is compared with
//! them ([`posterior`]). The result ([`find`]) also has the effect of errors of the roughness
//! ([`shifts`]) and whether the profiles describe the curves ([`deviation`]).

pub(crate) mod branches;
pub(crate) mod compared;
pub(crate) mod computed;
pub(crate) mod deviation;
pub(crate) mod find;
pub(crate) mod learn;
pub(crate) mod measured;
pub(crate) mod place;
pub(crate) mod posterior;
pub(crate) mod result;
pub(crate) mod scatter;
pub(crate) mod shifts;
pub(crate) mod summary;
pub(crate) mod table;

#[cfg(test)]
mod coverage;
#[cfg(test)]
mod other_bodies;
#[cfg(test)]
mod specimens;
