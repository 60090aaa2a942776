//! Hysteresis loops of prescribed displacement amplitude (Eq. 11, 12), sampled at uniformly spaced instants.

use crate::constant_load::complex_stiffness::check_amplitude;
use crate::constant_load::contact::Contact;
use crate::error::Error;
use core::f64::consts::PI;

/// The closed loop of one displacement amplitude (Eq. 11, 12).
#[derive(Debug, Clone, Copy)]
pub struct HysteresisLoop<'a> {
    contact: &'a Contact,
    amplitude: f64,
    /// Force at the upper reversal \[N\].
    top: f64,
}

impl Contact {
    /// The closed loop between ± a displacement amplitude \[m\].
    /// Errors: `BadAmplitude` if the amplitude is not finite, negative, or beyond 1e150.
    pub fn hysteresis_loop(&self, amplitude: f64) -> Result<HysteresisLoop<'_>, Error> {
        check_amplitude(amplitude)?;
        Ok(HysteresisLoop { contact: self, amplitude, top: self.response(amplitude).force })
    }
}

impl HysteresisLoop<'_> {
    /// Displacement \[m\] `amplitude cos t` at an instant, counted from 0 at t = 0, of a number of uniformly spaced instants in a
    /// period.
    pub fn displacement(&self, instant: usize, count: usize) -> f64 {
        let (sign, phase) = half_cycle(instant, count);
        sign * self.amplitude * (2.0 * PI * phase).cos()
    }

    /// Force \[N\] at that instant.
    pub fn force(&self, instant: usize, count: usize) -> f64 {
        let (sign, phase) = half_cycle(instant, count);
        // The distance from a reversal is amplitude (1 - cos t) = 2 amplitude sin²(t/2). The monotonic curve is evaluated at half
        // of it.
        let sine = (PI * phase).sin();
        // In gross slip both forces are mu N, so that the branch reaches -mu N exactly.
        sign * (self.top - 2.0 * self.contact.response(self.amplitude * sine * sine).force)
    }
}

/// The half-cycle to which an instant belongs: its sign, +1 for the first, and the fraction of a period since its reversal.
fn half_cycle(instant: usize, count: usize) -> (f64, f64) {
    let count = count.max(1);
    let phase = (instant % count) as f64 / count as f64;
    if phase < 0.5 { (1.0, phase) } else { (-1.0, phase - 0.5) }
}
