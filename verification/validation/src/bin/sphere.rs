//! Boundary elements of a sphere on a plane under tangential motion in both directions: Coulomb's law with vectors of traction and slip
//! at each of the squares into which the circle of contact is cut. Writes `tests/golden/two_directions_sphere.csv`, in some minutes.
//!
//! Bodies of equal elastic half-spaces, so that a normal load causes no tangential displacement; the pressure is that of Hertz, its mean
//! over each square. A translation and the pressure are even about the centre: so are the tractions, and half of the squares suffice.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Radius, Young's modulus and Poisson's ratio of both bodies, friction coefficient, and the largest load: E* = 1, b = 1.
const RADIUS: f64 = 1.0;
const POISSON_RATIO: f64 = 0.3;
const YOUNG_MODULUS: f64 = 2.0 * (1.0 - POISSON_RATIO * POISSON_RATIO);
const FRICTION_COEFFICIENT: f64 = 0.4;
const LARGEST_LOAD: f64 = 4.0 / 3.0;

/// Squares along the diameter, of the result and of the mesh that shows its error.
const MESHES: [usize; 2] = [45, 31];
/// Steps within a row: the limit of small steps is extrapolated from both.
const SUBSTEPS: [u32; 2] = [6, 12];
const ROWS_PER_ORBIT: u32 = 24;
/// The relaxation ends when no traction changes by more than this part of mu times the mean pressure.
const TOLERANCE: f64 = 1e-6;
const OVERRELAXATION: f64 = 1.4;

type Vector = [f64; 2];

/// u, v, N.
type Row = [f64; 3];

/// Force and energy dissipated since the start.
#[derive(Clone, Copy, Default)]
struct Point {
    force: Vector,
    dissipated: f64,
}

/// One half of the squares.
struct Mesh {
    /// Centres, and how many squares each stands for: itself and its image, or the centre alone.
    centres: Vec<Vector>,
    area: Vec<f64>,
    side: f64,
    /// Relative displacement at a square by the tractions of another one and of its image: xx, xy, yy.
    influence: Vec<[f64; 3]>,
}

/// Primitives of 1/r, x²/r³, xy/r³ and y²/r³ at the corner of a rectangle.
fn primitives([x, y]: Vector) -> [f64; 4] {
    let r = x.hypot(y);
    let (by_x, by_y) = (x * (y + r).ln(), y * (x + r).ln());
    [by_x + by_y, by_y, -r, by_x]
}

/// Relative displacement at a distance by a unit traction on a square (Love; Johnson, Contact Mechanics, Eq. 3.75).
fn square_influence([x, y]: Vector, side: f64) -> [f64; 3] {
    let half = 0.5 * side;
    let mut integrals = [0.0; 4];
    for (dx, dy, sign) in [(half, half, 1.0), (-half, half, -1.0), (half, -half, -1.0), (-half, -half, 1.0)] {
        let corner = primitives([x + dx, y + dy]);
        integrals.iter_mut().zip(corner).for_each(|(integral, value)| *integral += sign * value);
    }
    let [inverse, xx, xy, yy] = integrals;
    let shear_modulus = YOUNG_MODULUS / (2.0 * (1.0 + POISSON_RATIO));
    let both = 2.0 / (2.0 * PI * shear_modulus);
    let direct = (1.0 - POISSON_RATIO) * inverse;
    [direct + POISSON_RATIO * xx, POISSON_RATIO * xy, direct + POISSON_RATIO * yy].map(|value| both * value)
}

impl Mesh {
    fn new(squares: usize) -> Mesh {
        let side = 2.0 / squares as f64;
        let middle = squares / 2;
        let place = |i: usize| (i as f64 - middle as f64) * side;
        let mut centres = Vec::new();
        for i in 0..squares {
            for j in 0..squares {
                let centre = [place(i), place(j)];
                let nearest = centre[0].abs().max(0.5 * side) - 0.5 * side;
                let other = centre[1].abs().max(0.5 * side) - 0.5 * side;
                if (i, j) >= (middle, middle) && nearest.hypot(other) < 1.0 {
                    centres.push(centre);
                }
            }
        }
        let count = |centre: &Vector| if *centre == [0.0; 2] { 1.0 } else { 2.0 };
        let area = centres.iter().map(|centre| count(centre) * side * side).collect();
        let mut influence = Vec::with_capacity(centres.len() * centres.len());
        for at in &centres {
            for from in &centres {
                let mut sum = square_influence([at[0] - from[0], at[1] - from[1]], side);
                if *from != [0.0; 2] {
                    let image = square_influence([at[0] + from[0], at[1] + from[1]], side);
                    sum.iter_mut().zip(image).for_each(|(sum, image)| *sum += image);
                }
                influence.push(sum);
            }
        }
        Mesh { centres, area, side, influence }
    }

    /// Mean pressures over the squares, with the load exactly.
    fn pressures(&self, load: f64) -> Vec<f64> {
        const PARTS: usize = 24;
        let square = (load / LARGEST_LOAD).powf(2.0 / 3.0);
        let offset = |k: usize| (k as f64 + 0.5) / PARTS as f64 - 0.5;
        let mean = |centre: &Vector| {
            let mut sum = 0.0;
            for i in 0..PARTS {
                for j in 0..PARTS {
                    let (x, y) = (centre[0] + offset(i) * self.side, centre[1] + offset(j) * self.side);
                    sum += (square - x * x - y * y).max(0.0).sqrt();
                }
            }
            sum
        };
        let mut pressures: Vec<f64> = self.centres.iter().map(mean).collect();
        let total: f64 = pressures.iter().zip(&self.area).map(|(pressure, area)| pressure * area).sum();
        pressures.iter_mut().for_each(|pressure| *pressure *= load / total);
        pressures
    }

    /// A step of the displacement: new tractions, and the energy that it dissipates.
    fn step(&self, tractions: &mut [Vector], pressures: &[f64], step: Vector) -> f64 {
        let n = self.centres.len();
        let old = tractions.to_vec();
        let mut change = vec![[0.0; 2]; n];
        let limit = FRICTION_COEFFICIENT * LARGEST_LOAD / PI;
        let slip = |change: &[Vector], i: usize| {
            let row = &self.influence[i * n..(i + 1) * n];
            row.iter()
                .zip(change)
                .fold(step, |[x, y], ([xx, xy, yy], [qx, qy])| [x - xx * qx - xy * qy, y - xy * qx - yy * qy])
        };
        for _ in 0..2000 {
            let mut largest = 0.0_f64;
            for i in 0..n {
                let bound = FRICTION_COEFFICIENT * pressures[i];
                let [x, y] = slip(&change, i);
                let [xx, _, yy] = self.influence[i * n + i];
                let factor = OVERRELAXATION / (0.5 * (xx + yy));
                let now = tractions[i];
                let mut next = [now[0] + factor * x, now[1] + factor * y];
                let length = next[0].hypot(next[1]);
                if length > bound {
                    next = next.map(|component| component * bound / length);
                }
                largest = largest.max((next[0] - now[0]).hypot(next[1] - now[1]));
                change[i] = [next[0] - old[i][0], next[1] - old[i][1]];
                tractions[i] = next;
            }
            if largest <= TOLERANCE * limit {
                break;
            }
        }
        let work = |i: usize| {
            let ([x, y], [qx, qy]) = (slip(&change, i), tractions[i]);
            self.area[i] * (qx * x + qy * y)
        };
        (0..n).map(work).sum()
    }

    /// Points at the rows of a path; displacements and the tangential shift of the size are straight between them.
    fn walk(&self, rows: &[Row], substeps: u32) -> Vec<Point> {
        let mut tractions = vec![[0.0; 2]; self.centres.len()];
        let mut pressures = self.pressures(rows[0][2]);
        let mut points = vec![Point::default()];
        for pair in rows.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let mut dissipated = points[points.len() - 1].dissipated;
            for k in 1..=substeps {
                let part = f64::from(k) / f64::from(substeps);
                if from[2] != to[2] {
                    let shift = |load: f64| load.powf(2.0 / 3.0);
                    let shift = shift(from[2]) + part * (shift(to[2]) - shift(from[2]));
                    pressures = self.pressures(shift.powf(1.5));
                }
                let step = [0, 1].map(|k| (to[k] - from[k]) / f64::from(substeps));
                dissipated += self.step(&mut tractions, &pressures, step);
            }
            let sum = |k: usize| tractions.iter().zip(&self.area).map(|(traction, area)| traction[k] * area).sum();
            points.push(Point { force: [sum(0), sum(1)], dissipated });
        }
        points
    }

    /// The limit of small steps, whose error is of first order, and the change to it.
    fn limit(&self, rows: &[Row]) -> (Vec<Point>, Vec<Point>) {
        let [coarse, fine] = SUBSTEPS.map(|substeps| self.walk(rows, substeps));
        let extrapolated = |(coarse, fine): (&Point, &Point)| Point {
            force: [0, 1].map(|k| 2.0 * fine.force[k] - coarse.force[k]),
            dissipated: 2.0 * fine.dissipated - coarse.dissipated,
        };
        (coarse.iter().zip(&fine).map(extrapolated).collect(), fine)
    }
}

/// A circle, entered along x, of an amplitude in units of the displacement of gross slip under the largest load; the load swings between
/// `least` and 1 of the largest once in an orbit.
fn circle(amplitude: f64, least: f64) -> Vec<Row> {
    // mu S with S = U (2 - nu)/(2 (1 - nu)), U = b²/R.
    let slip = FRICTION_COEFFICIENT * (2.0 - POISSON_RATIO) / (2.0 * (1.0 - POISSON_RATIO)) / RADIUS;
    let radius = amplitude * slip;
    let entry =
        (0..ROWS_PER_ORBIT / 4).map(|i| [radius * f64::from(4 * i) / f64::from(ROWS_PER_ORBIT), 0.0, LARGEST_LOAD]);
    let orbit = (0..=ROWS_PER_ORBIT).map(|i| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(ROWS_PER_ORBIT)).sin_cos();
        let load = LARGEST_LOAD * (0.5 * (1.0 + least) + 0.5 * (1.0 - least) * cos);
        [radius * cos, radius * sin, load]
    });
    entry.chain(orbit).collect()
}

fn main() -> std::io::Result<()> {
    let paths = [
        ("circle0.3", circle(0.3, 1.0)),
        ("circle0.6", circle(0.6, 1.0)),
        ("circle0.9", circle(0.9, 1.0)),
        ("circle1.3", circle(1.3, 1.0)),
        ("circle0.4_loadvaries", circle(0.4, 0.4)),
    ];
    let [mesh, other] = MESHES.map(Mesh::new);
    let mut text = String::from("a,R,L,E,nu,mu,path,step,N,u,v,Tx,Ty,dissipated,error_T,error_dissipated\n");
    for (name, rows) in paths {
        let ((points, fine), (others, _)) = (mesh.limit(&rows), other.limit(&rows));
        let distance = |a: &Point, b: &Point| (a.force[0] - b.force[0]).hypot(a.force[1] - b.force[1]);
        for (step, row) in rows.iter().enumerate() {
            let (point, fine, other) = (&points[step], &fine[step], &others[step]);
            let of_step =
                |points: &[Point]| points[step].dissipated - if step > 0 { points[step - 1].dissipated } else { 0.0 };
            let (force, energy) = (distance(point, fine) / 2.0 + distance(point, other), of_step(&points));
            let error = 0.5 * (point.dissipated - fine.dissipated).abs() + (point.dissipated - other.dissipated).abs();
            let [u, v, load] = *row;
            writeln!(
                text,
                "0,{RADIUS:?},0,{YOUNG_MODULUS:?},{POISSON_RATIO},{FRICTION_COEFFICIENT},{name},{step},{load:?},{u:?},{v:?},{:.9},{:.9},{energy:.9e},{force:.1e},{error:.1e}",
                point.force[0], point.force[1]
            )
            .expect("a string");
        }
        let last = &points[points.len() - 1];
        eprintln!(
            "{name}: force {:?}, dissipated {}, other mesh {}",
            last.force,
            last.dissipated,
            others[others.len() - 1].dissipated
        );
    }
    fs::write(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/two_directions_sphere.csv"), text)
}
