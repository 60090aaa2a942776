//! The data of each figure.

use crate::cases::Case;
use crate::equations::Tractions;
use crate::swing;
use crate::table::Table;
use std::f64::consts::PI;

/// L/b where the paper's captions give none.
pub const LENGTH: f64 = 10.0;
/// The values of L/b in Fig. 9 and 14.
pub const LENGTHS: [f64; 4] = [5.0, 10.0, 20.0, 40.0];
/// a/b of the figures that compare shapes.
pub const SHAPES: [f64; 5] = [0.0, 0.5, 0.75, 0.9, 0.99];
/// a/b of the figures of one shape.
pub const SHAPE: f64 = 0.5;
/// a/b of the two shapes of Fig. 8; the first also of Fig. 9 and 14.
pub const NEARLY_CYLINDER: f64 = 0.1;
pub const NEARLY_FLAT: f64 = 0.9;
/// Displacement amplitudes of Fig. 8: below gross slip of both shapes, and beyond.
pub const AMPLITUDES: [f64; 2] = [3.2, 5.0];
/// a/R of Fig. 10, and its L/R.
pub const FLATS_OVER_RADIUS: [f64; 4] = [0.0, 0.02, 0.1, 0.5];
pub const LENGTH_OVER_RADIUS: f64 = 10.0;
/// Largest P/(E* R) of Fig. 10: b/R is 0.11 then for a cylinder, about as far as half-planes go.
pub const LARGEST_LOAD: f64 = 0.01;
/// Q/μP at the reversal, and after it, in the figure of tractions.
pub const REVERSAL: f64 = 0.8;
pub const AFTER_REVERSAL: [f64; 4] = [0.4, 0.0, -0.4, -0.8];

/// n + 1 uniformly spaced values.
pub fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|i| from + (to - from) * i as f64 / n as f64).collect()
}

/// The same on a logarithmic scale.
fn geometric(from: f64, to: f64, n: usize) -> Vec<f64> {
    even(from.ln(), to.ln(), n).into_iter().map(f64::exp).collect()
}

fn map(x: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    x.iter().copied().map(f).collect()
}

/// x/b over the width, denser near its ends and on both sides of ± each of the given places, where curves are steep. The places
/// themselves, where a term may be infinite, are left out.
fn across(places: &[f64]) -> Vec<f64> {
    let mut x = map(&even(-PI / 2.0, PI / 2.0, 240), f64::sin);
    for &place in places.iter().filter(|&&place| place > 0.0 && place < 1.0) {
        x.retain(|x| (x.abs() - place).abs() > 1e-4);
        let near = geometric(1e-4, 0.03, 8).into_iter();
        let both = near.flat_map(|step| [place - step, place + step]).filter(|x| x.abs() < 1.0);
        x.extend(both.flat_map(|x| [x, -x]));
    }
    x.sort_by(f64::total_cmp);
    x
}

pub fn all() -> Vec<Table> {
    let mut tables = vec![pressures(), shears()];
    tables.extend(loops_of_amplitudes());
    tables.extend([loops_of_shapes(), loops_of_lengths(), stiffness_under_load(), first_loading()]);
    tables.extend(complex_stiffness());
    tables.extend([energies("fig15a", even(0.0, 1.0, 120)), energies("fig15b", geometric(0.01, 1.0, 60))]);
    tables.push(oscillating_tractions());
    tables.extend(swing::tables());
    tables
}

fn shape_name(flat: f64) -> String {
    format!("a/b = {flat}")
}

fn pressures() -> Table {
    let shapes = [0.0, 0.25, 0.5, 0.75, 0.9, 0.99];
    let x = across(&shapes);
    shapes.iter().fold(Table::new("fig03").column("x/b", x.clone()), |table, &shape| {
        let case = Case::flat(shape, LENGTH);
        table.column(shape_name(shape), map(&x, |x| case.pressure(x)))
    })
}

fn shears() -> Table {
    let case = Case::flat(SHAPE, LENGTH);
    let forces = [0.2, 0.4, 0.6, 0.8, 1.0];
    let places: Vec<f64> = forces.iter().map(|&force| case.stick_zone(force)).collect();
    let x = across(&places);
    forces.iter().fold(Table::new("fig04").column("x/b", x.clone()), |table, &force| {
        table.column(format!("Q/μP = {force}"), map(&x, |x| case.shear(x, force)))
    })
}

/// Loops of amplitudes relative to the displacement of gross slip, and the initial loading curve.
fn loops_of_amplitudes() -> [Table; 2] {
    let case = Case::flat(NEARLY_CYLINDER, LENGTH);
    [("fig07a", [0.4, 0.7, 1.0]), ("fig07b", [1.0, 1.5, 2.0])].map(|(name, shares)| {
        let x = even(0.0, shares[2] * case.slip_displacement(), 240);
        let first = Table::new(name).curve("initial loading", x.clone(), map(&x, |x| case.force(x)));
        shares.iter().fold(first, |table, share| {
            let (x, y) = case.hysteresis_loop(share * case.slip_displacement(), 240);
            table.curve(&format!("δ0 = {share} δs"), x, y)
        })
    })
}

fn loops_of_shapes() -> Table {
    let pairs = AMPLITUDES.iter().flat_map(|&amplitude| [NEARLY_CYLINDER, NEARLY_FLAT].map(|shape| (amplitude, shape)));
    pairs.fold(Table::new("fig08"), |table, (amplitude, shape)| {
        let (x, y) = Case::flat(shape, LENGTH).hysteresis_loop(amplitude, 240);
        table.curve(&format!("{} to {amplitude}", shape_name(shape)), x, y)
    })
}

/// Loops at incipient gross slip.
fn loops_of_lengths() -> Table {
    LENGTHS.iter().fold(Table::new("fig09"), |table, &length| {
        let case = Case::flat(NEARLY_CYLINDER, length);
        let (x, y) = case.hysteresis_loop(case.slip_displacement(), 240);
        table.curve(&format!("L/b = {length}"), x, y)
    })
}

/// The second half is by Eq. 1 as printed, which is that of twice the radius.
fn stiffness_under_load() -> Table {
    let loads = map(&even(0.0, 1.0, 120), |share| LARGEST_LOAD * share.max(5e-3).powi(2));
    let readings = [(1.0, ""), (2.0, " by Eq. 1 as printed")];
    let curves = readings.iter().flat_map(|reading| FLATS_OVER_RADIUS.map(|flat| (reading, flat)));
    curves.fold(Table::new("fig10").column("P/(E* R)", loads.clone()), |table, (&(widened, name), flat)| {
        let stiffness = |load| Case::under_load(flat, LENGTH_OVER_RADIUS, load, widened).initial_stiffness();
        table.column(format!("a/R = {flat}{name}"), map(&loads, stiffness))
    })
}

fn first_loading() -> Table {
    let (cylinder, ellipse) = (Case::flat(0.0, LENGTH), Case::ellipse(LENGTH));
    let x = even(0.0, 1.1 * ellipse.slip_displacement(), 240);
    Table::new("fig11")
        .column("displacement", x.clone())
        .column("cylinder", map(&x, |x| cylinder.force(x)))
        .column("ellipse", map(&x, |x| ellipse.force(x)))
        .column("common tangent", map(&x, |x| 2.0 / PI * cylinder.initial_stiffness() * x))
}

/// Imaginary and real part, for shapes and for lengths.
fn complex_stiffness() -> [Table; 4] {
    let shapes = || SHAPES.iter().map(|&shape| (shape_name(shape), Case::flat(shape, LENGTH)));
    let lengths = || LENGTHS.iter().map(|&length| (format!("L/b = {length}"), Case::flat(NEARLY_CYLINDER, length)));
    let amplitudes = even(0.0, 12.0, 480);
    let part = |name, cases: &mut dyn Iterator<Item = (String, Case)>, imaginary: bool| {
        cases.fold(Table::new(name).column("amplitude", amplitudes.clone()), |table, (name, case)| {
            let value = |amplitude| {
                let (real, loss) = case.complex_stiffness(amplitude);
                if imaginary { loss } else { real }
            };
            table.column(name, map(&amplitudes, value))
        })
    };
    [
        part("fig13a", &mut shapes(), true),
        part("fig13b", &mut shapes(), false),
        part("fig14a", &mut lengths(), true),
        part("fig14b", &mut lengths(), false),
    ]
}

fn energies(name: &'static str, forces: Vec<f64>) -> Table {
    SHAPES.iter().fold(Table::new(name).column("Q/μP", forces.clone()), |table, &shape| {
        let case = Case::flat(shape, LENGTH);
        table.column(shape_name(shape), map(&forces, |force| case.energy(force)))
    })
}

/// Shear at the reversal and after it, up to the opposite one, between ±μp.
fn oscillating_tractions() -> Table {
    let case = Case::flat(SHAPE, LENGTH);
    let places: Vec<f64> = [REVERSAL].iter().chain(&[0.2, 0.4, 0.6]).map(|&force| case.stick_zone(force)).collect();
    let x = across(&places);
    let limit = Table::new("oscillating").column("x/b", x.clone()).column("±μp", map(&x, |x| case.pressure(x)));
    let first = limit.column(format!("Q/μP = {REVERSAL}"), map(&x, |x| case.shear(x, REVERSAL)));
    AFTER_REVERSAL.iter().fold(first, |table, &force| {
        let tractions = Tractions::after_reversal(&case, REVERSAL, force);
        table.column(format!("{force} after the reversal"), map(&x, |x| tractions.at(x)))
    })
}
