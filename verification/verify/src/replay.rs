//! The worst inputs that were found, which a table of regions keeps: each is compared with the reference again.

use crate::bounds::cells;
use crate::sampler::{Case, ElementCase, KINDS};
use crate::tally::Tally;
use crate::{call, curve, element, harmonic, history, layer, stiffness, tractions};
use microslip::{EllipticParameters, Layer, Material, Parameters};
use reference::{Input, Reference};
use std::collections::BTreeSet;
use std::path::Path;

/// A row of the table: output, kind of contact, range, and inputs as they were printed.
struct Row<'a> {
    output: &'a str,
    kind: &'static str,
    range: &'static str,
    inputs: &'a str,
}

fn row(line: &'static str) -> Row<'static> {
    let [output, kind, range, .., inputs] = cells(line)[..] else { panic!("{line}: not a region") };
    let [kind, range, inputs] = [kind, range, inputs].map(|cell| cell.trim_matches('"'));
    let kind = KINDS.into_iter().find(|known| *known == kind).unwrap_or_else(|| panic!("no contacts of kind {kind}"));
    Row { output, kind, range, inputs }
}

/// All numbers of a text.
fn numbers(text: &str) -> Vec<f64> {
    let between = |c: char| c == '[' || c == ']' || c == ',' || c == ' ';
    text.split(between).filter_map(|word| word.parse().ok()).collect()
}

/// The parameters at the beginning of inputs, and the text of the arguments behind them.
fn parameters(inputs: &str) -> (Input, &str) {
    let (is_flat, n) = (inputs.starts_with("a "), if inputs.starts_with("a ") { 18 } else { 14 });
    let end = inputs.match_indices(' ').nth(n - 1).map_or(inputs.len(), |(place, _)| place);
    let (own, arguments) = inputs.split_at(end);
    let values = numbers(own);
    let material = |at: usize| {
        [0, 1].map(|body| Material { young_modulus: values[at + body], poisson_ratio: values[at + 2 + body] })
    };
    let input = if is_flat {
        Input::Flat(Parameters {
            flat_half_width: values[0],
            edge_radius: values[1],
            length: values[2],
            normal_force: values[3],
            friction_coefficient: values[4],
            material: material(5),
            displacement_reference: values[9] as i32,
            layer: Layer::none(),
            reserved: 0,
        })
    } else {
        Input::Ellipse(EllipticParameters {
            semi_axis_x: values[0],
            semi_axis_y: values[1],
            normal_force: values[2],
            friction_coefficient: values[3],
            material: material(4),
            ..EllipticParameters::default()
        })
    };
    (input, arguments.trim_start())
}

/// Whether the inputs are complete: of the rest, the tractions of histories, only a part is printed.
fn of_contact(row: &Row, input: Input, arguments: &str, tally: &mut Tally) -> bool {
    let Some(contact) = call::prepare(&input) else { return false };
    let case = &Case { contact, reference: Reference::new(input), kind: row.kind };
    let words: Vec<&str> =
        arguments.split(' ').filter(|word| word.parse::<f64>().is_err() && !word.is_empty()).collect();
    let (values, range) = (numbers(arguments), row.range);
    match (words.first().copied(), words.len(), values.as_slice()) {
        (None, ..) => curve::fields(case, &mut crate::Sampler::new(0), tally),
        (Some("c_t"), _, &[tangential_compliance, stiffening_load, value]) => {
            let layer = Layer { normal_compliance: 0.0, tangential_compliance, stiffening_load, reference_load: 0.0 };
            layer::at(case, layer, (words[2], value), range, tally);
        }
        (Some("T"), 1, &[force]) => curve::at_force(case, force, range, tally),
        (Some("T"), 2, &[force, x]) => tractions::at_positions(case, force, &[(x, range)], true, tally),
        (Some("u"), 1, &[displacement]) if row.output.starts_with("sensitivity") => {
            curve::sensitivity(case, displacement, range, tally);
        }
        (Some("u"), 1, &[displacement]) => curve::at_displacement(case, displacement, range, tally),
        (Some("A"), 1, &[amplitude]) => stiffness::at_amplitude(case, amplitude, range, tally),
        (Some("A"), _, &[amplitude, _, n]) => history::of_amplitude(case, amplitude, n as usize, range, tally),
        (Some("path"), _, path) => drop(history::updates(case, path, tally)),
        (Some("samples"), _, [samples, u @ ..]) => harmonic::at(case, *samples as usize, u, range, tally),
        (Some("sliders"), _, &[n]) => curve::of_sliders(case, n as usize, tally),
        _ => return false,
    }
    true
}

/// The normal input of an element is not printed: it is the one whose size under the load of the parameters is nearer.
fn of_element(row: &Row, input: &Input, arguments: &str, tally: &mut Tally) -> bool {
    let values = numbers(arguments);
    let (path, rest) = values.as_chunks();
    let largest = path.iter().fold(0.0f64, |largest, [_, w]| largest.max(*w));
    let far = |by_force: bool| {
        let full = element::prepare(input, by_force)
            .map(|(element, _)| if by_force { element.normal_force } else { element.approach });
        full.map_or(f64::INFINITY, |full| (largest / full).ln().abs())
    };
    let Some((element, reference)) = element::prepare(input, far(true) < far(false)) else { return false };
    let case = &ElementCase { element, reference, kind: row.kind, input: *input };
    match (arguments.split(' ').next(), values.as_slice()) {
        (Some("N"), &[load]) => drop(element::at_load(case, load, row.range, tally)),
        (Some("w"), &[approach]) => element::at_approach(case, approach, row.range, tally),
        (Some("path"), _) if rest.is_empty() => drop(element::steps(case, path, row.range, tally)),
        _ => return false,
    }
    true
}

/// Compares all rows of a table, and prints how many.
pub fn replay(path: &Path, tally: &mut Tally) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let rows = text.leak().lines().skip(1).map(row);
    let (mut seen, mut replayed) = (BTreeSet::new(), 0);
    for row in rows {
        let sensitivity = row.output.starts_with("sensitivity");
        if !seen.insert((row.inputs, sensitivity)) {
            continue;
        }
        let (input, arguments) = parameters(row.inputs);
        let is_element = row.output.starts_with("element") || row.output.starts_with("normal");
        let done = if is_element {
            of_element(&row, &input, arguments, tally)
        } else {
            of_contact(&row, input, arguments, tally)
        };
        replayed += usize::from(done);
    }
    println!("{replayed} of {} worst cases compared", seen.len());
    // All but the tractions of histories have complete inputs: fewer are a table or a format that has changed.
    assert!(replayed * 20 > seen.len() * 19, "{}: too few cases can be read", path.display());
}
