//! Tangential forces of the samples, run by run.

use crate::varying_load::element::Element;
use crate::varying_load::harmonic_force::samples::{Samples, at};
use crate::varying_load::harmonic_force::walk::{Kind, Place, RUN, Run};

/// Arrays of the tangential forces.
#[derive(Debug)]
pub(super) struct Tractions<'a> {
    /// T of the samples.
    pub force: &'a mut [f64],
    /// N at the packed boundaries of the slip zones, and 1/K_t.
    pub cut_load: &'a mut [f64],
    pub cut_stiffness: &'a mut [f64],
    /// D of the pieces that samples made by sticking.
    pub slope: &'a mut [f64],
    /// T and N at the boundary of the slip zone at the last sample of a run.
    pub last_cut_force: &'a mut [f64],
    pub last_cut_load: &'a mut [f64],
}

impl Tractions<'_> {
    /// Evaluates N, and 1/K_t if requested, at the boundaries of the slip zones.
    #[inline(always)]
    pub fn evaluate_cuts(&mut self, element: &Element, cut_shift: &[f64], _with_stiffness: bool) {
        for ((shift, load), stiffness) in
            cut_shift.iter().zip(self.cut_load.iter_mut()).zip(self.cut_stiffness.iter_mut())
        {
            (*load, *stiffness) = element.load_at_shift(shift.max(0.0));
        }
    }

    /// `[N, T]` at the end of a piece.
    #[inline(always)]
    fn at_place(&self, samples: &Samples, place: Place) -> [f64; 2] {
        match place {
            Place::Centre => [0.0; 2],
            Place::End(sample) => [at(samples.load, sample), at(self.force, sample)],
            Place::Cut(sample) => [at(self.last_cut_load, sample), at(self.last_cut_force, sample)],
        }
    }

    /// Evaluates the forces of all runs, from the loads at the boundaries.
    #[inline(always)]
    pub fn evaluate(&mut self, friction_coefficient: f64, samples: &Samples, runs: &[[f64; RUN]]) {
        for run in runs {
            let run = Run::from(*run);
            let range = run.first..run.first + run.count;
            let [inner_load, inner_force] = self.at_place(samples, run.inner);
            let loads = samples.load.get(range.clone()).unwrap_or(&[]);
            let mu = run.sign * friction_coefficient;
            match run.kind {
                Kind::Open => self.force.get_mut(range).unwrap_or(&mut []).fill(0.0),
                Kind::GrossSlip => {
                    for (force, load) in self.force.get_mut(range).unwrap_or(&mut []).iter_mut().zip(loads) {
                        *force = mu * load;
                    }
                }
                Kind::Stuck => {
                    let (mut load_before, mut force_before) = (inner_load, inner_force);
                    let (mut xi_before, mut eta_before) = (run.xi, run.eta);
                    let xi = samples.xi.get(range.clone()).unwrap_or(&[]);
                    let eta = samples.eta.get(range.clone()).unwrap_or(&[]);
                    let slopes = self.slope.get_mut(range.clone()).unwrap_or(&mut []);
                    let forces = self.force.get_mut(range).unwrap_or(&mut []);
                    for ((((force, slope), &load), &xi), &eta) in
                        forces.iter_mut().zip(slopes).zip(loads).zip(xi).zip(eta)
                    {
                        let (falling, rising) = (xi_before - xi, eta - eta_before);
                        *slope = mu * ((rising - falling) / (rising + falling));
                        force_before += *slope * (load - load_before);
                        *force = force_before;
                        (xi_before, eta_before, load_before) = (xi, eta, load);
                    }
                }
                Kind::Slip => {
                    let slope = friction_coefficient * run.slope;
                    let cuts = self.cut_load.get(run.packed..run.packed + run.count).unwrap_or(&[]);
                    let forces = self.force.get_mut(range).unwrap_or(&mut []);
                    for ((force, &load), &cut_load) in forces.iter_mut().zip(loads).zip(cuts) {
                        *force = inner_force + slope * (cut_load - inner_load) + mu * (load - cut_load);
                    }
                    let last = run.first + run.count - 1;
                    let cut_load = cuts.last().copied().unwrap_or(0.0);
                    if let Some(place) = self.last_cut_load.get_mut(last) {
                        *place = cut_load;
                    }
                    if let Some(place) = self.last_cut_force.get_mut(last) {
                        *place = inner_force + slope * (cut_load - inner_load);
                    }
                }
            }
        }
    }
}
