//! Statements of the derivation about springs and slip: for a cylinder, a flat with rounded edges and a rough layer, at
//! loads up to that of the nodes.

use super::nodes::{Nodes, PerAxis, Row, SPRINGS, Units, by_axis, length};
use super::shells::{ScaledNormalState, Springs};
use super::slip::{Metric, Slip};
use super::step::LoadedContact;
use crate::element::{Directions, Element, NormalInput};
use crate::numerics::slices::Zero;
use crate::parameters::{Layer, Material, Parameters};

/// Sums of 16 terms have rounding errors of 1e-15; those of a thin shell are ten times as large.
const ROUNDING: f64 = 1e-13;
/// Newton's method for the angles of the tractions stops at 1e-11.
const ANGLE: f64 = 1e-10;

const MATERIAL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

/// Calls a check for contacts, their nodes and their springs.
fn for_contacts(check: impl Fn(&LoadedContact, &Nodes, &Springs)) {
    let cylinder = Parameters {
        flat_half_width: 0.0,
        edge_radius: 0.05,
        length: 0.02,
        normal_force: 800.0,
        friction_coefficient: 0.5,
        material: [MATERIAL; 2],
        displacement_reference: 1,
        ..Parameters::default()
    };
    let layer = Layer { tangential_compliance: 2e-9, stiffening_load: 300.0, ..Layer::none() };
    let flat = Parameters { flat_half_width: 2e-3, ..cylinder };
    for parameters in [cylinder, flat, Parameters { layer, ..cylinder }, Parameters { layer, ..flat }] {
        let element = Element::rounded_flat(&parameters, Directions::Two, NormalInput::Force).unwrap();
        let (units, mut nodes, mut springs) = (Units::at_load(&element, 800.0), Nodes::zero(), Springs::ZERO);
        nodes.fill(&element, &units, 1.0);
        for load in [800.0, 799.0, 500.0, 90.0, 3.0, 1e-3] {
            let state = ScaledNormalState::new(&element, &units, load, &element.normal(load));
            let contact = LoadedContact::new(&nodes, &state);
            springs.set(&nodes, [&contact.shells; 2]);
            check(&contact, &nodes, &springs);
        }
    }
}

/// In gross slip the springs carry the normal force, and all tractions are at their bound. No entry of C⁻¹ is negative.
#[test]
fn gross_slip() {
    for_contacts(|contact, nodes, springs| {
        let limits = contact.limits(nodes);
        for axis in 0..2 {
            let force: f64 = (0..SPRINGS).map(|j| springs.stiffness[axis][j] * limits[axis][j]).sum();
            let edge = contact.shells.edge_stiffness[axis] * contact.normal.edge_limits()[axis];
            assert!(((force + edge) / contact.normal.load - 1.0).abs() < ROUNDING, "{force:e} {edge:e}");
        }
        for j in contact.shells.range() {
            let rows = [springs.inverse[0][j], springs.inverse[1][j]];
            assert!(rows.iter().all(|row| row.iter().all(|entry| *entry >= -ROUNDING * row[j])), "{j}: {rows:?}");
        }
        let tractions = springs.tractions(&[0.6 * limits[0], 0.8 * limits[1]]);
        for i in contact.shells.range() {
            let error = length([tractions[0][i] - 0.6, tractions[1][i] - 0.8]);
            assert!(error < ROUNDING, "{i}: {error:e}");
        }
    });
}

/// On a line each spring stops at its own limit. In the plane tractions are within Coulomb's bound, and a point slips
/// only at the bound, in the direction of its traction.
#[test]
fn slip() {
    for_contacts(|contact, nodes, springs| {
        let limits = contact.limits(nodes);
        let find = |trial: PerAxis<Row>| {
            let (mut slip, mut metric) = (Slip::ZERO, Metric::ZERO);
            slip.find(&mut metric, springs, trial, contact.normal.load);
            slip.points
        };
        let innermost = limits[0][contact.shells.innermost()];
        let on_a_line = |part: f64| [(part * innermost) * contact.in_use(), Row::ZERO];
        for part in [0.1, 0.5, 0.9, 1.5] {
            let (trial, used) = (on_a_line(part), contact.shells.range());
            let points = find(trial);
            for j in used {
                let expected = trial[0][j].min(limits[0][j]);
                assert!((points.v[0][j] - expected).abs() <= ROUNDING * limits[0][j], "{part} {j}");
            }
        }
        for turn in 0..8 {
            let angle = f64::from(turn);
            let push = on_a_line(0.7)[0];
            let trial = [0.8 * angle.cos() * limits[0] + push, 0.8 * angle.sin() * limits[1] - 0.3 * push];
            let points = find(trial);
            // Sweeps alone find the same springs, but slowly: ten times as many reduce the error to a tenth.
            let (mut swept, tractions) = (Slip::ZERO.points, springs.tractions(&trial));
            let mut q = tractions;
            swept.v = trial;
            (0..10).for_each(|_| swept.sweep(springs, &tractions, &mut q));
            for j in contact.shells.range() {
                let error = by_axis(|axis| (swept.v[axis][j] - points.v[axis][j]) / innermost);
                assert!(length(error) < 1e-2, "{turn} {j}: {error:?}");
            }
            let largest = (0..SPRINGS).map(|i| length([points.r[0][i], points.r[1][i]])).fold(0.0, f64::max);
            for i in contact.shells.range() {
                let (q, r) = (by_axis(|axis| points.q[axis][i]), by_axis(|axis| points.r[axis][i]));
                assert!(length(q) < 1.0 + 2e-12, "{turn} {i}: {q:?}");
                let (along, across) = (q[0] * r[0] + q[1] * r[1], q[0] * r[1] - q[1] * r[0]);
                assert!(along >= 0.0 && across.abs() <= ANGLE * largest, "{turn} {i}: {along:e} {across:e}");
                assert!(length(r) == 0.0 || length(q) > 1.0 - ROUNDING);
            }
        }
    });
}
