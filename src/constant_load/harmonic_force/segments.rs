//! Gauss-Legendre quadrature over one segment of the event-driven rule.
//!
//! On a segment the force is analytic in time: after a reversal it depends on `u - u_r ~ (t - t_r)²` alone. A segment that ends at
//! the onset of gross slip has a singularity there, a power of the cube root of the distance; its nodes are those of the cube root.

use super::motion::{Motion, harmonics};
use crate::fourier::workspace::{Parts, SamplingSize};
use crate::numerics::lanes::Lanes;
use crate::numerics::quadrature::{MAX_GAUSS_BLOCKS, gauss_rule};
use crate::numerics::slices::PanicFreeSlice;
use core::f64::consts::PI;

/// Fewest blocks of four nodes on a segment.
const MIN_BLOCKS: usize = 2;
const MIN_BLOCKS_TO_SLIP: usize = 4;

/// Factor on the number of nodes if the curve has a knee: it is a singularity at complex times near the segment, and convergence is
/// slower. With 2 the error of the force is 9e-7 of μN for N_c = N/1000, with 3 it is as small as without a layer.
const KNEE_DENSITY: f64 = 3.0;

/// Largest number of nodes in a panel; longer segments are divided into panels.
pub(super) const PANEL: usize = 4 * MAX_GAUSS_BLOCKS;

/// Values at the nodes of a panel.
type PanelNodes = [[f64; 4]; MAX_GAUSS_BLOCKS];

/// The interval of time between two events.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub from: f64,
    pub to: f64,
    /// Gross slip starts at its end.
    pub to_slip: bool,
    /// The layer bends the curve strongly near gross slip.
    pub has_knee: bool,
}

impl Segment {
    /// Number of panels for a density of nodes, and their rule.
    fn panels(&self, nodes_per_period: usize) -> (usize, &'static [[[f64; 4]; 2]]) {
        // Nodes of the cube root are three times as far apart at the start of the segment.
        let (density, fewest) = if self.to_slip { (2.0, MIN_BLOCKS_TO_SLIP) } else { (1.0, MIN_BLOCKS) };
        let density = if self.has_knee { KNEE_DENSITY * density } else { density };
        let blocks_per_radian = nodes_per_period as f64 / (8.0 * PI);
        let blocks = ((density * (self.to - self.from) * blocks_per_radian + 0.5) as usize).max(fewest);
        let count = blocks.div_ceil(MAX_GAUSS_BLOCKS);
        (count, gauss_rule(blocks.div_ceil(count.max(1))))
    }

    /// Instants and weights of the nodes of a panel.
    fn nodes(&self, panel: usize, panels: usize, rule: &[[[f64; 4]; 2]]) -> [PanelNodes; 2] {
        let Segment { from, to, to_slip, .. } = *self;
        let (length, fraction) = (to - from, 1.0 / panels as f64);
        let [mut times, mut weights]: [PanelNodes; 2] = [[[0.0; 4]; _]; _];
        for ((times, weights), [nodes, rule_weights]) in times.iter_mut().zip(weights.iter_mut()).zip(rule) {
            let s = (panel as f64 + Lanes(*nodes)) * fraction;
            let weight = length * fraction * Lanes(*rule_weights);
            if to_slip {
                let root = 1.0 - s;
                *times = *(to - length * (root * root * root));
                *weights = *(3.0 * root * root * weight);
            } else {
                (*times, *weights) = (*(from + length * s), *weight);
            }
        }
        [times, weights]
    }
}

/// Fourier sums over the nodes of a panel.
pub(super) struct NodalFourier<'a> {
    nodes_per_period: usize,
    /// cos and sin of each order at the nodes of a panel.
    rows: &'a mut [[PanelNodes; 2]],
}

impl<'a> NodalFourier<'a> {
    /// For orders up to 2H.
    pub fn take(parts: &mut Parts<'a>, size: SamplingSize) -> NodalFourier<'a> {
        let rows = parts.take_blocks(4 * size.harmonics * MAX_GAUSS_BLOCKS).blocks_mut().blocks_mut();
        NodalFourier { nodes_per_period: size.samples, rows }
    }

    /// Adds the integrals over a segment of functions of the displacement, times 1, cos t, sin t, cos 2t, ..., to the sums of each
    /// function. A function with empty sums is not integrated. `orders` is the highest order of all sums.
    pub fn integrate<const K: usize>(
        &mut self,
        motion: &Motion,
        segment: Segment,
        orders: usize,
        functions: impl Fn(f64) -> [f64; K],
        mut sums: [&mut [f64]; K],
    ) {
        let (panels, rule) = segment.panels(self.nodes_per_period);
        for panel in 0..panels {
            let [times, weights] = segment.nodes(panel, panels, rule);
            let mut displacement: PanelNodes = [[0.0; 4]; _];
            fill_rows(self.rows, motion, orders, times.part(..rule.len()), &mut displacement);
            let mut values: [PanelNodes; K] = [[[0.0; 4]; _]; _];
            for (block, displacement) in displacement.iter().enumerate().take(rule.len()) {
                let at_nodes = displacement.map(&functions);
                let by_function: [_; K] = core::array::from_fn(|k| at_nodes.map(|node| node[k]));
                for (values, value) in values.iter_mut().zip(by_function) {
                    values.set(block, value);
                }
            }
            for (values, sums) in values.iter().zip(&mut sums).filter(|(_, sums)| !sums.is_empty()) {
                self.add(weights.part(..rule.len()), values, sums);
            }
        }
    }

    /// Adds the products of weights and values at the nodes of a panel with 1, cos t, sin t, cos 2t, ..., one for each of `sums`.
    fn add(&self, weights: &[[f64; 4]], values: &PanelNodes, sums: &mut [f64]) {
        let Some((constant, pairs)) = sums.split_first_mut() else { return };
        let mut products: PanelNodes = [[0.0; 4]; _];
        let mut sum = Lanes::ZERO;
        for ((product, weight), value) in products.iter_mut().zip(weights).zip(values) {
            *product = *(Lanes(*weight) * Lanes(*value));
            sum += Lanes(*product);
        }
        *constant += sum.sum();
        let products = products.part(..weights.len());
        for ([by_cosine, by_sine], [cosines, sines]) in pairs.blocks_mut::<2>().iter_mut().zip(self.rows.iter()) {
            let (mut c, mut s) = (Lanes::ZERO, Lanes::ZERO);
            for ((product, cosine), sine) in products.iter().zip(cosines).zip(sines) {
                c += Lanes(*product) * Lanes(*cosine);
                s += Lanes(*product) * Lanes(*sine);
            }
            *by_cosine += c.sum();
            *by_sine += s.sum();
        }
    }
}

/// Evaluates cos and sin of all orders up to `orders`, and the displacement, at the nodes of a panel.
fn fill_rows(
    rows: &mut [[PanelNodes; 2]],
    motion: &Motion,
    orders: usize,
    times: &[[f64; 4]],
    displacement: &mut PanelNodes,
) {
    for (block, (times, displacement)) in times.iter().zip(displacement.iter_mut()).enumerate() {
        let harmonics = harmonics(Lanes(*times).map(f64::cos), Lanes(*times).map(f64::sin));
        let mut u = Lanes([motion.mean; 4]);
        let mut pairs = motion.pairs.iter();
        for ([cosines, sines], [c, s]) in rows.iter_mut().take(orders).zip(harmonics) {
            cosines.set(block, *c);
            sines.set(block, *s);
            if let Some(&[a, b]) = pairs.next() {
                u += a * c + b * s;
            }
        }
        *displacement = *u;
    }
}
