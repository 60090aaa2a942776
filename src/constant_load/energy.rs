//! Energy dissipated along a load history (Eq. 13-16 with Masing's rule).
//!
//! One initial loading dissipates a quarter of the energy of its cycle, a branch twice that of its half range. Segments that
//! follow each other on one branch are one segment, and only its ends are evaluated.

use crate::constant_load::contact::Contact;
use crate::constant_load::memory::Segment;

/// Adds up the energy of segments.
#[derive(Debug)]
pub(crate) struct Dissipation<'a> {
    contact: &'a Contact,
    sum: f64,
    open: Segment,
}

impl<'a> Dissipation<'a> {
    pub fn new(contact: &'a Contact) -> Dissipation<'a> {
        Dissipation { contact, sum: 0.0, open: Segment { scale: 0.0, start: 0.0, end: 0.0, slip_length: 0.0 } }
    }

    #[inline(always)]
    pub fn add(&mut self, segment: Segment) {
        if segment.scale == self.open.scale && segment.start == self.open.end {
            self.open.end = segment.end;
            self.open.slip_length += segment.slip_length;
        } else {
            self.close();
            self.open = segment;
        }
    }

    /// Energy of a cycle of that displacement amplitude, up to gross slip.
    #[inline(never)]
    fn cycle_energy(&self, amplitude: f64) -> f64 {
        if amplitude <= 0.0 {
            0.0
        } else if amplitude >= self.contact.slip_displacement {
            self.contact.slip_energy
        } else {
            let interpolated = self.contact.inner_cycle_energy(amplitude);
            interpolated.unwrap_or_else(|| self.contact.cycle_energy(self.contact.before_slip(amplitude)).0)
        }
    }

    fn close(&mut self) {
        let Segment { scale, start, end, slip_length } = self.open;
        if end > start {
            let difference = self.cycle_energy(end) - self.cycle_energy(start);
            self.sum += 0.25 * scale * if difference > 0.0 { difference } else { 0.0 };
        }
        self.sum += self.contact.slip_force * slip_length;
    }

    /// The energy \[J\] of all segments.
    pub fn total(mut self) -> f64 {
        self.close();
        self.sum
    }
}
