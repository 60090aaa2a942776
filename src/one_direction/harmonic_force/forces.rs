//! Tangential forces of the samples, run by run.

use crate::element::Element;
use crate::numerics::slices::PanicFreeSlice;
use crate::one_direction::harmonic_force::runs::{PieceEnd, Run};
use crate::one_direction::harmonic_force::samples::Samples;

/// Arrays of the tangential forces.
pub(super) struct Forces<'a> {
    /// T of the samples.
    pub force: &'a mut [f64],
    /// N at the packed boundaries of the slip zones, and 1/K_t.
    pub cut_load: &'a mut [f64],
    pub cut_stiffness: &'a mut [f64],
    /// D of the pieces that were loaded between two samples while everything stuck.
    pub slope: &'a mut [f64],
    /// N and T at the boundary of the slip zone at the last sample of a run.
    pub last_cut: &'a mut [[f64; 2]],
}

impl Forces<'_> {
    /// `[N, T]` at the end of a piece.
    fn at_piece_end(&self, samples: &Samples, end: PieceEnd) -> [f64; 2] {
        let sample = end.sample();
        if end.is_end() {
            [samples.load.or_zero(sample), self.force.or_zero(sample)]
        } else {
            self.last_cut.get(sample).copied().unwrap_or([0.0; 2])
        }
    }

    /// Evaluates the forces of all runs from the shifts at the boundaries of the slip zones; if `SLOPES`, also 1/K_t there.
    /// Not inlined: beside the rest of a harmonic force its loops take a tenth more time.
    #[inline(never)]
    pub fn evaluate<const SLOPES: bool>(
        &mut self,
        element: &Element,
        samples: &Samples,
        cut_shift: &[[f64; 4]],
        runs: &[Run],
    ) {
        // Whole blocks of four at the boundaries of the slip zones.
        let loads = self.cut_load.blocks_mut::<4>();
        let stiffnesses = self.cut_stiffness.blocks_mut::<4>();
        for ((shift, load), stiffness) in cut_shift.iter().zip(loads).zip(stiffnesses) {
            let (loads, stiffnesses) = element.loads_at::<SLOPES, 4>(shift);
            *load = loads;
            if SLOPES {
                *stiffness = stiffnesses;
            }
        }
        let friction_coefficient = element.friction_coefficient;
        for run in runs {
            let range = run.samples();
            let inner = self.at_piece_end(samples, run.inner);
            let loads = run.part_of(samples.load);
            let forces = self.force.part_mut(range.clone());
            let slip_slope = run.sign * friction_coefficient;
            match run.kind {
                Run::OPEN | Run::GROSS_SLIP => {
                    forces.iter_mut().zip(loads).for_each(|(force, load)| *force = slip_slope * load);
                }
                Run::STUCK => {
                    let slopes = self.slope.part_mut(range.clone());
                    stick(samples, run, slip_slope, slopes, inner, forces);
                }
                _ => {
                    let [inner_load, inner_force] = inner;
                    let slope = friction_coefficient * run.parameter;
                    let cuts = self.cut_load.part(run.cuts());
                    for ((force, &load), &cut_load) in forces.iter_mut().zip(loads).zip(cuts) {
                        *force = inner_force + slope * (cut_load - inner_load) + slip_slope * (load - cut_load);
                    }
                    if let Some(&cut_load) = cuts.last() {
                        let force = inner_force + slope * (cut_load - inner_load);
                        self.last_cut.set(range.end - 1, [cut_load, force]);
                    }
                }
            }
        }
    }
}

/// Slopes and forces of samples that stick.
fn stick(samples: &Samples, run: &Run, slip_slope: f64, slopes: &mut [f64], inner: [f64; 2], forces: &mut [f64]) {
    let [mut load_before, mut force_before] = inner;
    let before = samples.before(run.samples().start);
    let [mut xi_before, mut eta_before] = if run.inner == PieceEnd::CENTRE {
        [run.parameter; 2]
    } else {
        [samples.xi.or_zero(before), samples.eta.or_zero(before)]
    };
    for ((slope, &xi), &eta) in slopes.iter_mut().zip(run.part_of(samples.xi)).zip(run.part_of(samples.eta)) {
        let (falling, rising) = (xi_before - xi, eta - eta_before);
        *slope = slip_slope * ((rising - falling) / (rising + falling).max(f64::MIN_POSITIVE));
        (xi_before, eta_before) = (xi, eta);
    }
    for ((force, &slope), &load) in forces.iter_mut().zip(slopes.iter()).zip(run.part_of(samples.load)) {
        force_before += slope * (load - load_before);
        *force = force_before;
        load_before = load;
    }
}
