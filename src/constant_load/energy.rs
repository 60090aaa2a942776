//! Dissipated energy: of a cycle of prescribed amplitude (Eq. 13-16), and along a load history, by Masing's rule.
//!
//! Initial loading up to a displacement dissipates a quarter of the energy of the cycle of this amplitude. A branch dissipates half
//! the energy of the cycle whose amplitude is its half range. Consecutive segments of one branch are joined, and only the ends are
//! evaluated.

use crate::constant_load::contact::Contact;
use crate::constant_load::memory::StepSegment;
use crate::error::{Error, ensure};
use crate::numerics::fp_class::in_0_to;
use crate::shape::stick_zone::StickZone;

impl Contact {
    /// Energy \[J\] dissipated per cycle between ± a force amplitude \[N\], at most mu N (Eq. 13-16).
    /// Errors: `BadForceAmplitude` if the amplitude is not finite or negative, `ForceExceedsSlip` if it exceeds mu N.
    pub fn dissipated_energy(&self, force_amplitude: f64) -> Result<f64, Error> {
        self.check_force_amplitude(force_amplitude)?;
        let point = self.curve_at_force(force_amplitude)?;
        let dissipation = |zone: StickZone| self.zones.dissipation(zone.load, zone.compliance_increase).0;
        Ok(point.stick_zone().map_or(0.0, |zone| self.energy_scale() * dissipation(zone)))
    }

    pub(crate) fn check_force_amplitude(&self, force_amplitude: f64) -> Result<(), Error> {
        ensure(in_0_to(force_amplitude, f64::MAX), Error::BadForceAmplitude)?;
        self.check_force(force_amplitude)
    }

    /// Energy \[J\] dissipated per cycle of a displacement amplitude, and its derivative with respect to the amplitude \[N\].
    pub(crate) fn energy_of_cycle(&self, amplitude: f64) -> (f64, f64) {
        if self.is_frictionless() || amplitude >= self.slip_displacement {
            let slope = 4.0 * self.slip_force;
            return (self.slip_energy + slope * (amplitude - self.slip_displacement), slope);
        }
        let zones = &self.zones;
        let (load, increase) = self.load_of_energy(self.before_slip(amplitude));
        let (dissipation, slope) = zones.dissipation(load, increase);
        (self.energy_scale() * dissipation, self.slip_force * slope / (zones.small_load.compliance + increase))
    }
}

/// Adds up the energy of segments.
pub(crate) struct Dissipation<'a> {
    contact: &'a Contact,
    sum: f64,
    last: StepSegment,
}

impl<'a> Dissipation<'a> {
    pub fn new(contact: &'a Contact) -> Dissipation<'a> {
        Dissipation { contact, sum: 0.0, last: StepSegment { scale: 0.0, start: 0.0, end: 0.0, slip_length: 0.0 } }
    }

    pub fn add(&mut self, segment: StepSegment) {
        if segment.scale == self.last.scale && segment.start == self.last.end {
            self.last.end = segment.end;
            self.last.slip_length += segment.slip_length;
        } else {
            self.add_last();
            self.last = segment;
        }
    }

    /// Energy of a cycle between ± a displacement.
    #[inline(never)]
    fn cycle_energy(&self, amplitude: f64) -> f64 {
        if amplitude > 0.0 { self.contact.energy_of_cycle(amplitude).0 } else { 0.0 }
    }

    fn add_last(&mut self) {
        let StepSegment { scale, start, end, slip_length } = self.last;
        if end > start {
            let difference = self.cycle_energy(end) - self.cycle_energy(start);
            self.sum += 0.25 * scale * if difference > 0.0 { difference } else { 0.0 };
        }
        self.sum += self.contact.slip_force * slip_length;
    }

    /// The energy \[J\] of all segments.
    pub fn total(mut self) -> f64 {
        self.add_last();
        self.sum
    }
}
