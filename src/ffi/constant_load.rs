//! The law under a constant normal force: contacts and their curve, load histories, cycles.

pub(super) mod contact;
pub(super) mod history;

pub(super) mod cycle;
