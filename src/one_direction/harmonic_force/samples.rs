//! Normal states and characteristic coordinates of the samples.

use crate::element::Element;
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;

/// Arrays over the samples of a period, continued periodically to whole blocks of four.
pub(super) struct Samples<'a> {
    pub count: usize,
    pub displacement: &'a mut [f64],
    /// Normal approach or force.
    pub input: &'a mut [f64],
    /// N, S and their derivatives with respect to the input; 0 if open.
    pub load: &'a mut [f64],
    pub shift: &'a mut [f64],
    pub load_slope: &'a mut [f64],
    pub shift_slope: &'a mut [f64],
    /// 1/K_t of the whole contact.
    pub stiffness: &'a mut [f64],
    /// u - mu S and u + mu S.
    pub xi: &'a mut [f64],
    pub eta: &'a mut [f64],
}

/// The part of a period that is evaluated.
#[derive(Clone, Copy)]
pub(super) struct EvaluatedPart {
    /// First sample: one at which the steady state is known.
    pub start: usize,
    /// Whether the motion is half-wave symmetric, so that half a period is evaluated: u has only odd orders, the normal component
    /// only even ones, and the number of samples is even. After half a period ξ and -η have changed places, and the tangential
    /// force its sign.
    pub half_wave: bool,
    /// Whether some samples are open.
    pub opens: bool,
}

/// The evaluated samples up to the end of the arrays, and those from their start on.
pub(super) fn ranges(part: &EvaluatedPart, samples: usize) -> [core::ops::Range<usize>; 2] {
    let end = part.start + if part.half_wave { samples / 2 } else { samples };
    if end <= samples { [part.start..end, 0..0] } else { [part.start..samples, 0..end - samples] }
}

impl Samples<'_> {
    pub fn before(&self, sample: usize) -> usize {
        sample.checked_sub(1).unwrap_or(self.count.saturating_sub(1))
    }

    pub fn is_open(&self, sample: usize) -> bool {
        self.input.or_zero(sample) <= 0.0
    }

    /// The normal states of all samples, with derivatives if requested.
    pub fn press<const SLOPES: bool>(&mut self, element: &Element) {
        let inputs = self.input.blocks::<4>().iter();
        let outputs =
            [&mut self.load, &mut self.shift, &mut self.load_slope, &mut self.shift_slope, &mut self.stiffness];
        let [load, shift, load_slope, shift_slope, stiffness] = outputs.map(|values| values.blocks_mut::<4>());
        let outputs = load.iter_mut().zip(shift).zip(load_slope).zip(shift_slope).zip(stiffness);
        for (input, ((((load, shift), load_slope), shift_slope), stiffness)) in inputs.zip(outputs) {
            let [loads, shifts, slopes @ ..] = element.four_normals::<SLOPES>(input);
            (*load, *shift) = (loads, shifts);
            if SLOPES {
                [*load_slope, *shift_slope] = slopes;
                // 0 if open.
                let divisors = shift_slope.map(|slope| if slope > 0.0 { slope } else { 1.0 });
                *stiffness = (Lanes(*load_slope) / Lanes(divisors)).0;
            }
        }
    }

    /// Characteristic coordinates, and the part of the period to evaluate.
    ///
    /// The definition starts at the sample of largest normal force with D = 0 everywhere and evaluates the second of two periods.
    /// With ξ_max and η_min of all samples, the state is the same at one sample of the first period whatever the history:
    ///
    /// - at an open sample: it is empty;
    /// - ξ_max > 0: the centre has at most this displacement, so the sample of ξ_max is one of gross slip, and o = ξ_max; η_min < 0
    ///   accordingly;
    /// - otherwise there is no gross slip and o = 0; the part of the diagram with D = 0 that is never reached ends at S =
    ///   min(-ξ_max, η_min)/mu. At the sample where that is attained everything beyond is slip zone.
    pub fn enter_steady_state(&mut self, element: &Element, half_wave: bool, least_input: f64) -> EvaluatedPart {
        let mu = element.friction_coefficient;
        let (mut largest, mut smallest) = ([f64::MIN; 4], [f64::MAX; 4]);
        let blocks = self.displacement.blocks::<4>().iter().zip(self.shift.blocks::<4>());
        for (block, (displacement, shift)) in blocks.enumerate() {
            let (displacement, limit) = (Lanes(*displacement), mu * Lanes(*shift));
            let (x, y) = (displacement - limit, displacement + limit);
            for k in 0..4 {
                largest[k] = if x[k] > largest[k] { x[k] } else { largest[k] };
                smallest[k] = if y[k] < smallest[k] { y[k] } else { smallest[k] };
            }
            self.xi.blocks_mut().set(block, *x);
            self.eta.blocks_mut().set(block, *y);
        }
        let largest = largest.into_iter().fold(f64::MIN, f64::max);
        let smallest = smallest.into_iter().fold(f64::MAX, f64::min);
        let first = |values: &[f64], value: f64| values.iter().position(|v| *v == value).unwrap_or(0);
        let opens = !element.is_closed(least_input);
        let start = if opens {
            self.input.iter().position(|input| *input <= 0.0).unwrap_or(0)
        } else if largest > 0.0 || (smallest >= 0.0 && -largest <= smallest) {
            first(self.xi, largest)
        } else {
            first(self.eta, smallest)
        };
        EvaluatedPart { start, half_wave, opens }
    }
}
