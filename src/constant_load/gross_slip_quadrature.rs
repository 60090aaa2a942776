//! The quadrature rule of K' in gross slip: computed with a contact, for all amplitudes.

use crate::numerics::sn_midpoint::GAUSS;
use crate::shape::stick_zone::StickZones;

/// Quadrature rule of K' in gross slip, the same for all amplitudes: x at the nodes, and the weights of an integral over τ.
pub(crate) type GrossSlipQuadrature = [[f64; GAUSS.len()]; 2];

pub(crate) const NO_QUADRATURE: GrossSlipQuadrature = [[0.0; GAUSS.len()]; 2];

/// The rule over all stick zones: the spacing of the size parameters is proportional to the distance from the branch points, and
/// decreases towards b, at which the integrands have square roots.
pub(crate) fn gross_slip_quadrature(zones: &dyn StickZones) -> GrossSlipQuadrature {
    let extent = zones.log_branch_distance();
    // σ = sinh(extent y)/sinh(extent), y = z (2-z).
    let scale = 0.5 / (0.5 * (extent.exp() - (-extent).exp()));
    let mut nodes = NO_QUADRATURE;
    let [shifts, weights] = &mut nodes;
    for ((shift, load_weight), (z, weight)) in shifts.iter_mut().zip(weights).zip(GAUSS) {
        let (up, down) = ((extent * z * (2.0 - z)).exp(), (-extent * z * (2.0 - z)).exp());
        let rate = extent * scale * (up + down) * 2.0 * (1.0 - z);
        let point = zones.quadrature_point((scale * (up - down)).min(1.0));
        (*shift, *load_weight) = (point.shift.consumed, weight * rate * point.dload_dsigma);
    }
    nodes
}
