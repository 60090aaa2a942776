//! Gauss-Legendre quadrature of force and stiffness over one segment of the event-driven rule.
//!
//! On a segment the force is analytic in time: after a reversal it depends on `u - u_r ~ (t - t_r)²` alone. A segment that ends at
//! the onset of gross slip has a singularity there, a power of the cube root of the distance; its nodes are those of the cube root.

use super::Requested;
use super::motion::Motion;
use crate::constant_load::masing::BranchEvaluator;
use crate::numerics::quadrature::{MAX_GAUSS_BLOCKS, gauss_rule};
use crate::simd::dispatch;
use core::f64::consts::PI;

/// Fewest blocks of four nodes on a segment.
const MIN_BLOCKS: usize = 2;
const MIN_BLOCKS_TO_SLIP: usize = 4;

/// Largest number of nodes in a panel; longer segments are divided into panels.
pub(super) const PANEL: usize = 4 * MAX_GAUSS_BLOCKS;

/// Values at the nodes of a panel.
type Nodes = [[f64; 4]; MAX_GAUSS_BLOCKS];

/// The interval of time between two events.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub from: f64,
    pub to: f64,
    /// Gross slip starts at its end.
    pub to_slip: bool,
}

/// The nodes of a segment, panel by panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panels {
    segment: Segment,
    count: usize,
    rule: &'static [[[f64; 4]; 2]],
}

impl Segment {
    /// The rule for a density of nodes.
    #[inline(always)]
    pub fn panels(self, nodes_per_period: usize) -> Panels {
        // Nodes of the cube root are three times as far apart at the start of the segment.
        let (density, fewest) = if self.to_slip { (2.0, MIN_BLOCKS_TO_SLIP) } else { (1.0, MIN_BLOCKS) };
        let blocks_per_radian = nodes_per_period as f64 / (8.0 * PI);
        let blocks = ((density * (self.to - self.from) * blocks_per_radian + 0.5) as usize).max(fewest);
        let count = blocks.div_ceil(MAX_GAUSS_BLOCKS);
        Panels { segment: self, count, rule: gauss_rule(blocks.div_ceil(count.max(1))) }
    }
}

impl Panels {
    /// Instants and weights of the nodes of a panel.
    #[inline(always)]
    fn nodes(&self, panel: usize) -> [Nodes; 2] {
        let Segment { from, to, to_slip } = self.segment;
        let (length, fraction) = (to - from, 1.0 / self.count as f64);
        let [mut times, mut weights]: [Nodes; 2] = [[[0.0; 4]; _]; _];
        for ((times, weights), [nodes, rule_weights]) in times.iter_mut().zip(weights.iter_mut()).zip(self.rule) {
            for k in 0..4 {
                let s = (panel as f64 + nodes[k]) * fraction;
                let weight = length * fraction * rule_weights[k];
                if to_slip {
                    let root = 1.0 - s;
                    times[k] = to - length * (root * root * root);
                    weights[k] = 3.0 * root * root * weight;
                } else {
                    times[k] = from + length * s;
                    weights[k] = weight;
                }
            }
        }
        [times, weights]
    }

    /// Calls a function for the instant and the weight of each node.
    pub fn for_each(&self, mut function: impl FnMut(f64, f64)) {
        for panel in 0..self.count {
            let [times, weights] = self.nodes(panel);
            let nodes = times.as_flattened().iter().zip(weights.as_flattened());
            nodes.take(4 * self.rule.len()).for_each(|(&t, &weight)| function(t, weight));
        }
    }
}

/// Fourier integrals over segments.
#[derive(Debug)]
pub(super) struct Integrals<'a> {
    pub harmonics: usize,
    pub nodes_per_period: usize,
    /// cos and sin of each order up to 2H at the nodes of a panel.
    pub basis: &'a mut [f64],
    /// Of the force, up to the order H, accumulated.
    pub force: &'a mut [f64],
    /// Of the stiffness, up to the order 2H, over the latest segment.
    pub segment_stiffness: &'a mut [f64],
    /// Of the stiffness, up to the order 2H, accumulated.
    pub stiffness: &'a mut [f64],
}

impl Integrals<'_> {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.force.fill(0.0);
        self.stiffness.fill(0.0);
    }

    /// Adds the integrals over a segment without gross slip; `force` and `segment_stiffness` only.
    pub fn add(&mut self, evaluator: &BranchEvaluator, motion: &Motion, segment: Segment, requested: Requested) {
        let Requested { force, stiffness } = requested;
        let panels = segment.panels(self.nodes_per_period);
        let rule = panels.rule;
        let orders = if stiffness { 2 * self.harmonics } else { self.harmonics };
        if stiffness {
            self.segment_stiffness.fill(0.0);
        }
        for panel in 0..panels.count {
            let [times, weights] = panels.nodes(panel);
            let times = times.get(..rule.len()).unwrap_or(&[]);
            let mut forces: Nodes = [[0.0; 4]; _];
            let mut stiffnesses = weights;
            let mut displacement: Nodes = [[0.0; 4]; _];
            fill_basis(self.basis, motion, orders, times, &mut displacement);
            let nodes = displacement.iter().zip(&weights).take(rule.len());
            for ((forces, stiffnesses), (displacement, weights)) in
                forces.iter_mut().zip(stiffnesses.iter_mut()).zip(nodes)
            {
                for k in 0..4 {
                    let response = evaluator.at(displacement[k]);
                    forces[k] = weights[k] * response.force;
                    stiffnesses[k] = weights[k] * response.stiffness;
                }
            }
            if force {
                add_sums(self.force, self.basis, forces.get(..rule.len()).unwrap_or(&[]));
            }
            if stiffness {
                add_sums(self.segment_stiffness, self.basis, stiffnesses.get(..rule.len()).unwrap_or(&[]));
            }
        }
    }
}

/// Evaluates cos and sin of all orders up to `orders`, and the displacement, at the nodes of a panel.
#[inline(always)]
fn fill_basis(basis: &mut [f64], motion: &Motion, orders: usize, times: &[[f64; 4]], displacement: &mut Nodes) {
    dispatch!(basis_kernel(basis, motion, orders, times, displacement));
}

#[inline(always)]
fn basis_kernel(basis: &mut [f64], motion: &Motion, orders: usize, times: &[[f64; 4]], displacement: &mut Nodes) {
    let rows = basis.as_chunks_mut::<4>().0.as_chunks_mut::<{ 2 * MAX_GAUSS_BLOCKS }>().0;
    for (block, (times, displacement)) in times.iter().zip(displacement.iter_mut()).enumerate() {
        let (mut cosine, mut sine) = ([0.0; 4], [0.0; 4]);
        for k in 0..4 {
            (sine[k], cosine[k]) = times[k].sin_cos();
        }
        let (mut c, mut s) = (cosine, sine);
        let mut u = [motion.mean; 4];
        let mut pairs = motion.pairs.iter();
        for row in rows.iter_mut().take(orders) {
            let (cosines, sines) = row.split_at_mut(MAX_GAUSS_BLOCKS);
            if let (Some(cosines), Some(sines)) = (cosines.get_mut(block), sines.get_mut(block)) {
                (*cosines, *sines) = (c, s);
            }
            if let Some(&[a, b]) = pairs.next() {
                for k in 0..4 {
                    u[k] += a * c[k] + b * s[k];
                }
            }
            for k in 0..4 {
                (c[k], s[k]) = (c[k] * cosine[k] - s[k] * sine[k], s[k] * cosine[k] + c[k] * sine[k]);
            }
        }
        *displacement = u;
    }
}

/// Adds the weighted values at the nodes of a panel to Fourier sums.
#[inline(always)]
fn add_sums(sums: &mut [f64], basis: &[f64], values: &[[f64; 4]]) {
    dispatch!(sums_kernel(sums, basis, values));
}

#[inline(always)]
fn sums_kernel(sums: &mut [f64], basis: &[f64], values: &[[f64; 4]]) {
    let total = |[one, two, three, four]: [f64; 4]| (one + two) + (three + four);
    let Some((constant, pairs)) = sums.split_first_mut() else { return };
    let mut sum = [0.0; 4];
    for value in values {
        for k in 0..4 {
            sum[k] += value[k];
        }
    }
    *constant += total(sum);
    let rows = basis.as_chunks::<4>().0.as_chunks::<{ 2 * MAX_GAUSS_BLOCKS }>().0;
    for ([by_cosine, by_sine], row) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(rows) {
        let (cosines, sines) = row.split_at(MAX_GAUSS_BLOCKS);
        let (mut c, mut s) = ([0.0; 4], [0.0; 4]);
        for ((value, cosine), sine) in values.iter().zip(cosines).zip(sines) {
            for k in 0..4 {
                c[k] += value[k] * cosine[k];
                s[k] += value[k] * sine[k];
            }
        }
        *by_cosine += total(c);
        *by_sine += total(s);
    }
}
