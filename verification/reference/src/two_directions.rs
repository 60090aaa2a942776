//! The law of two tangential directions by its equations: shells of sizes with one point each, as many as requested, Coulomb's law at the
//! points by sweeps, small steps of backward Euler, extrapolated from two lengths. In doubles; N, U and S of a size are those of the family.
//!
//! Shell j has ΔN_j, ΔS_j of both directions, and the pressures F_ij at the points x_i, at one part of their shells:
//!
//! ```text
//! T = Σ k_j v_j,   k_j = ΔN_j/ΔS_j - ΔN_{j-1}/ΔS_{j-1}
//! μ p_i q_i = Σ_{j>=i} F_ij/ΔS_j (v_j - v_{j+1}),   p_i = Σ_j F_ij,   |q_i| <= 1
//! ```

use crate::family::{Family, Given, Size};
use crate::{Input, Real};
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Parameters};
use std::f64::consts::{FRAC_PI_2, PI};

/// Force at the end of a row of a path, and energy dissipated in the row.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub force: [f64; 2],
    pub dissipated: f64,
}

/// Part of the shells that are under a flat.
const UNDER_FLAT: f64 = 0.15;
/// Part of the nodes that is uniform in the logarithm of the distance to the edge in √S, and the least of these distances. The others are
/// uniform in √N ψ.
const EDGE_SHARE: f64 = 0.75;
const GRADING: f64 = 0.01;
/// The position of a point in its shell.
const POINT: f64 = 0.1;
/// A shell thinner than this part of S would consist of rounding errors.
const THINNEST: f64 = 1e-9;
/// Overrelaxation of the sweeps, change of a traction over its limit at which they end, and their largest number.
const OVERRELAXATION: f64 = 1.7;
const CONVERGED: f64 = 1e-8;
const SWEEPS: usize = 20_000;
/// Nodes and weights of Gauss-Legendre on -1 to 1.
const GAUSS: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
    [-0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.0, 0.568_888_888_888_888_9],
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.906_179_845_938_664, 0.236_926_885_056_189_1],
];

/// A size in doubles: w, N, and S of both directions.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    w: f64,
    load: f64,
    shift: [f64; 2],
}

/// A contact, divided into shells up to the size under a largest load.
pub struct Contact {
    family: Family,
    /// The family of an ellipse for forces along y.
    turned: Option<Family>,
    friction: f64,
    /// Compliance of the layer without load, and N_c.
    layer: [f64; 2],
    /// a, and of a line 2/(π E* L), 2L, ν/(1 - ν) and R/(L E*).
    flat: f64,
    line: [f64; 4],
    under_flat: usize,
    nodes: Vec<Node>,
    whole: Shells,
}

/// ΔN, ΔS, and F, a row of points for each shell. Shells under a flat carry no pressure: theirs is that of the force 1, and ΔS a compliance.
#[derive(Clone, Default)]
struct Shells {
    load: Vec<f64>,
    shift: [Vec<f64>; 2],
    pressure: Vec<Vec<f64>>,
}

/// k, C and the compliance Σ C²/k of each point, in each direction.
struct Springs {
    stiffness: [Vec<f64>; 2],
    map: [Vec<Vec<f64>>; 2],
    compliance: [Vec<f64>; 2],
}

struct State {
    at: [f64; 2],
    size: Node,
    v: [Vec<f64>; 2],
    force: [f64; 2],
    stored: f64,
}

impl Contact {
    /// Two bodies of one material; displacements of a line contact are those of the centre point.
    pub fn new(input: &Input, largest_load: f64, springs: usize) -> Contact {
        let (Input::Flat(Parameters { layer, normal_force, friction_coefficient, material, .. })
        | Input::Ellipse(EllipticParameters { layer, normal_force, friction_coefficient, material, .. })) = *input;
        assert!(material[0] == material[1], "two materials");
        let (nu, young) = (material[0].poisson_ratio, material[0].young_modulus);
        let modulus = 0.5 * young / (1.0 - nu * nu);
        let reference_load = if layer.reference_load > 0.0 { layer.reference_load } else { normal_force };
        let knee = if layer.stiffening_load > 0.0 { layer.stiffening_load } else { f64::INFINITY };
        let (flat, line, turned) = match *input {
            Input::Flat(p) => {
                assert!(p.displacement_reference == CENTRE_POINT, "not the centre point");
                let unit = 2.0 / (PI * modulus * p.length);
                (p.flat_half_width, [unit, 2.0 * p.length, nu / (1.0 - nu), p.edge_radius / (p.length * modulus)], None)
            }
            Input::Ellipse(p) => {
                let turned = EllipticParameters { semi_axis_x: p.semi_axis_y, semi_axis_y: p.semi_axis_x, ..p };
                (0.0, [0.0; 4], Some(Family::new(&Input::Ellipse(turned))))
            }
        };
        let under_flat = if flat > 0.0 { ((UNDER_FLAT * springs as f64) as usize).max(1) } else { 0 };
        let mut contact = Contact {
            family: Family::new(input),
            turned,
            friction: friction_coefficient,
            layer: [layer.tangential_compliance * (1.0 + reference_load / knee), knee],
            flat,
            line,
            under_flat,
            nodes: vec![Node::default(); under_flat + 1],
            whole: Shells::default(),
        };
        let largest = contact.under_load(largest_load);
        let density = |node: &Node| {
            let distance = 1.0 - (1.0 - GRADING) * (node.shift[0] / largest.shift[0]).sqrt();
            let curved = (node.load / largest.load).sqrt() * contact.weight(node.w) / contact.weight(largest.w);
            EDGE_SHARE * distance.ln() / GRADING.ln() + (1.0 - EDGE_SHARE) * curved
        };
        let at = |target: f64| {
            let [mut low, mut high] = [0.0, largest.w];
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                *(if density(&contact.node(middle)) < target { &mut low } else { &mut high }) = middle;
            }
            contact.node(high)
        };
        let outer = springs - under_flat;
        let nodes: Vec<Node> = (1..outer).map(|j| at(j as f64 / outer as f64)).collect();
        contact.nodes.extend(nodes);
        for j in 0..springs {
            let shells = contact.shells(j, if j + 1 < springs { &contact.nodes[j + 1] } else { &largest });
            contact.whole = shells;
        }
        contact
    }

    fn of_size(&self, size: &Size) -> Node {
        let [w, load, approach, x] = [&size.w, &size.load, &size.approach, &size.shift].map(Real::f64);
        let y = match &self.turned {
            Some(turned) => turned.find(Given::Load, &size.load).shift.f64(),
            None => (1.0 + self.line[2]) * approach - self.line[2] * self.line[0] * load,
        };
        let [compliance, knee] = self.layer;
        let layer = if knee < f64::INFINITY { compliance * knee * (load / knee).ln_1p() } else { compliance * load };
        Node { w, load, shift: [x + layer, y + layer] }
    }

    fn node(&self, w: f64) -> Node {
        self.of_size(&self.family.size(&self.family.real(w)))
    }

    fn under_load(&self, load: f64) -> Node {
        self.of_size(&self.family.find(Given::Load, &self.family.real(load)))
    }

    /// The size of S_x, from another one: secants of logarithms.
    fn under_shift(&self, shift: f64, near: &Node) -> Node {
        let (mut node, mut power) = (*near, 2.0);
        for _ in 0..20 {
            let distance = (shift / node.shift[0]).ln();
            if distance.abs() < 1e-14 {
                break;
            }
            let next = self.node(node.w * (distance / power).exp());
            let [moved, stretched] = [next.shift[0] / node.shift[0], next.w / node.w].map(f64::ln);
            // Rounding determines the power of a shorter one.
            power = if stretched.abs() > 1e-9 { moved / stretched } else { power };
            node = next;
        }
        node
    }

    /// ψ.
    fn weight(&self, w: f64) -> f64 {
        if self.flat > 0.0 { w.atan2(self.flat) } else { FRAC_PI_2 }
    }

    /// s of node j.
    fn half_width(&self, j: usize) -> f64 {
        let inner = |j: usize| (FRAC_PI_2 * j as f64 / self.under_flat as f64).sin();
        if j < self.under_flat { self.flat * inner(j) } else { self.nodes[j].w.hypot(self.flat) }
    }

    /// x and x² - a² of the point of shell j, which ends at a size.
    fn point(&self, j: usize, end: &Node) -> [f64; 2] {
        let from = self.half_width(j);
        if j < self.under_flat {
            let x = from + POINT * (self.half_width(j + 1) - from);
            return [x, (x - self.flat) * (x + self.flat)];
        }
        let w = self.nodes[j].w;
        let part = POINT * (end.w - w) * (end.w + w) / (from + end.w.hypot(self.flat));
        [from + part, w * w + part * (2.0 * from + part)]
    }

    /// F of shell j, which ends at a size, at a point: ∫ ψ dt with t² = s² - x²; under the flat the force is spread evenly.
    fn pressure(&self, j: usize, end: &Node, [x, square]: [f64; 2]) -> f64 {
        if j < self.under_flat {
            let [from, to] = [self.half_width(j), self.half_width(j + 1)];
            return self.line[3] * ((to / x).acosh() - (from / x).max(1.0).acosh()) / (to - from);
        }
        let [from, to] = [self.nodes[j].w, end.w].map(|w| (w * w - square).max(0.0).sqrt());
        let value = |[x, weight]: [f64; 2]| {
            let t = 0.5 * (from + to) + 0.5 * (to - from) * x;
            weight * self.weight((t * t + square).max(0.0).sqrt())
        };
        0.5 * (to - from) * GAUSS.map(value).iter().sum::<f64>()
    }

    /// Whole shells and a last one, which ends at a size.
    fn shells(&self, last: usize, end: &Node) -> Shells {
        let Shells { load, shift, pressure } = &self.whole;
        let under_flat = last < self.under_flat;
        let steps = if under_flat {
            let [unit, twice, ratio, _] = self.line;
            let log = (2.0 * twice / (self.half_width(last) + self.half_width(last + 1))).ln();
            [log + ratio, (1.0 + ratio) * log - ratio].map(|log| unit * log + self.layer[0])
        } else {
            [0, 1].map(|k| end.shift[k] - self.nodes[last].shift[k])
        };
        let row = (0..=last).map(|i| {
            let own = self.pressure(last, end, self.point(i, if i < last { &self.nodes[i + 1] } else { end }));
            // F/ΔS does not increase with j.
            let bound = |k: usize| if i < last { pressure[last - 1][i] * steps[k] / shift[k][last - 1] } else { own };
            own.min(bound(0)).min(bound(1))
        });
        let with = |values: &[f64], value: f64| [&values[..last], &[value]].concat();
        Shells {
            pressure: pressure[..last].iter().cloned().chain([row.collect()]).collect(),
            load: with(load, if under_flat { 1.0 } else { end.load - self.nodes[last].load }),
            shift: [0, 1].map(|k| with(&shift[k], steps[k])),
        }
    }

    /// The springs of a size.
    fn springs(&self, size: &Node) -> Springs {
        let inside = |node: &&Node| node.shift[0] < (1.0 - THINNEST) * size.shift[0];
        let count = self.nodes.iter().filter(inside).count();
        let Shells { load, shift, pressure } = self.shells(count - 1, size);
        let sum = |i: usize| (i.max(self.under_flat)..count).map(|j| pressure[j][i]).sum::<f64>();
        let limit: Vec<f64> = (0..count).map(|i| self.friction * sum(i)).collect();
        let stiffness = [0, 1].map(|k| {
            let secant = |j: usize| load[j] / shift[k][j];
            (0..count).map(|j| secant(j) - if j > 0 { secant(j - 1) } else { 0.0 }).collect::<Vec<f64>>()
        });
        let map = [0, 1].map(|k| {
            let g = |i: usize, j: usize| pressure[j][i] / (shift[k][j] * limit[i]);
            let entry = |i: usize, j: usize| if j < i { 0.0 } else { g(i, j) - if j > i { g(i, j - 1) } else { 0.0 } };
            (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect()).collect::<Vec<Vec<f64>>>()
        });
        let compliance = [0, 1].map(|k| {
            let of = |row: &Vec<f64>| row.iter().zip(&stiffness[k]).map(|(c, stiffness)| c * c / stiffness).sum();
            map[k].iter().map(of).collect()
        });
        Springs { stiffness, map, compliance }
    }

    /// A straight step in S and in the displacement; the dissipated energy is the work less what the springs store.
    fn step(&self, state: &mut State, size: &Node, springs: &Springs, to: [f64; 2]) -> f64 {
        let (before, count) = (state.force, springs.stiffness[0].len());
        let by = [0, 1].map(|k| to[k] - state.at[k]);
        for (k, v) in state.v.iter_mut().enumerate() {
            let rise = size.shift[k] - state.size.shift[k];
            v.resize(count, 0.0);
            for (v, node) in v.iter_mut().zip(&self.nodes) {
                let limit = size.shift[k] - node.shift[k];
                *v += by[k] * if rise > limit { limit / rise } else { 1.0 };
            }
        }
        springs.slip(&mut state.v);
        let sum = |of: &dyn Fn(usize, usize) -> f64, k: usize| (0..count).map(|j| of(k, j)).sum::<f64>();
        state.force = [0, 1].map(|k| sum(&|k, j| springs.stiffness[k][j] * state.v[k][j], k));
        let stored: f64 = (0..2).map(|k| sum(&|k, j| 0.5 * springs.stiffness[k][j] * state.v[k][j].powi(2), k)).sum();
        let work: f64 = (0..2).map(|k| 0.5 * (before[k] + state.force[k]) * by[k]).sum();
        let dissipated = work - (stored - state.stored);
        (state.at, state.size, state.stored) = (to, *size, stored);
        dissipated
    }

    /// A path of u, v and N, straight in u, v and S_x between its rows, each in a number of steps. Its first row makes contact.
    fn advance(&self, path: &[[f64; 3]], steps: usize) -> Vec<Point> {
        let [u, v, load] = path[0];
        let size = self.under_load(load);
        let mut springs = self.springs(&size);
        let mut state = State { at: [u, v], size, v: [vec![], vec![]], force: [0.0; 2], stored: 0.0 };
        let rows = path.windows(2).map(|rows| {
            let (varies, from, end) = (rows[1][2] != rows[0][2], state.size, self.under_load(rows[1][2]));
            let mut dissipated = 0.0;
            for i in 1..=steps {
                let part = i as f64 / steps as f64;
                let size = match (varies, i < steps) {
                    (true, true) => {
                        self.under_shift(from.shift[0] + part * (end.shift[0] - from.shift[0]), &state.size)
                    }
                    (true, false) => end,
                    (false, _) => from,
                };
                if varies {
                    springs = self.springs(&size);
                }
                let to = [0, 1].map(|k| rows[0][k] + part * (rows[1][k] - rows[0][k]));
                dissipated += self.step(&mut state, &size, &springs, to);
            }
            Point { force: state.force, dissipated }
        });
        rows.collect()
    }

    /// Force and energy at each row of a path but the first one, which makes contact without a tangential force. Two step lengths are
    /// extrapolated, of which a row has the given number and twice as many.
    pub fn solve(&self, path: &[[f64; 3]], steps: usize) -> Vec<Point> {
        let [coarse, fine] = [steps, 2 * steps].map(|steps| self.advance(path, steps));
        let extrapolated = |(coarse, fine): (&Point, &Point)| Point {
            force: [0, 1].map(|k| 2.0 * fine.force[k] - coarse.force[k]),
            dissipated: 2.0 * fine.dissipated - coarse.dissipated,
        };
        coarse.iter().zip(&fine).map(extrapolated).collect()
    }
}

impl Springs {
    /// Coulomb's law: relaxes springs by slip `v_j -= Σ_i C_ij r_i/k_j` so that at each point |q| <= 1, and r is 0 or along q with |q| = 1.
    fn slip(&self, v: &mut [Vec<f64>; 2]) {
        let count = self.stiffness[0].len();
        let mut slips = vec![[0.0; 2]; count];
        for _ in 0..SWEEPS {
            let mut change = 0.0_f64;
            for i in (0..count).rev() {
                let compliance = [0, 1].map(|k| self.compliance[k][i]);
                let traction = |k: usize| self.map[k][i][i..].iter().zip(&v[k][i..]).map(|(c, v)| c * v).sum::<f64>();
                let stuck = [0, 1].map(|k| traction(k) + compliance[k] * slips[i][k]);
                let slip = slip_of(stuck, compliance);
                let factor = if slip == [0.0; 2] { 1.0 } else { OVERRELAXATION };
                for (k, v) in v.iter_mut().enumerate() {
                    let step = factor * (slip[k] - slips[i][k]);
                    change = change.max((step * compliance[k]).abs());
                    slips[i][k] += step;
                    if step != 0.0 {
                        let springs = self.map[k][i].iter().zip(&self.stiffness[k]);
                        v.iter_mut().zip(springs).skip(i).for_each(|(v, (c, stiffness))| *v -= c * step / stiffness);
                    }
                }
            }
            if change < CONVERGED {
                return;
            }
        }
        panic!("the sweeps do not converge");
    }
}

/// The slip along q with |q| = 1 and q = `stuck` less compliances times slip, 0 if `stuck` is within: Newton's method for |slip|, from below.
fn slip_of(stuck: [f64; 2], compliance: [f64; 2]) -> [f64; 2] {
    if stuck[0].hypot(stuck[1]) <= 1.0 {
        return [0.0; 2];
    }
    let mut length = 0.0;
    loop {
        let q = [0, 1].map(|k| stuck[k] / (1.0 + compliance[k] * length));
        let q_length = q[0].hypot(q[1]);
        let slope = (0..2).map(|k| q[k] * q[k] * compliance[k] / (1.0 + compliance[k] * length)).sum::<f64>();
        let step = (q_length - 1.0) * q_length * q_length / slope;
        length += step;
        if step <= 1e-14 * length {
            return q.map(|q| length * q);
        }
    }
}
