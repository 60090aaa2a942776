//! Properties of long adversarial histories, most of them to the bit: Coulomb's bound, energy, odd symmetry, restart from the
//! reversals, and the error that bounded memory reports. With a layer and without.

use crate::call;
use crate::element::prepare;
use crate::histories::{self, OF_CONTACTS, OF_ELEMENTS};
use crate::layer;
use crate::sampler::{Case, ElementCase, Sampler};
use microslip::law::StepResult;
use microslip::one_direction::{self as state, Law, OneDirection};

/// Reversals or pieces that a state holds: none are merged.
const ENOUGH: usize = 520;

/// Doubles before the reversals of a state: tag with the number of reversals, displacement, slip direction, force, offset.
const HEADER: usize = 6;
/// Displacement, force and error.
const PER_REVERSAL: usize = 3;

/// The number of reversals or pieces.
fn used(state: &[f64]) -> usize {
    state[1] as usize
}

/// A constant load.
pub fn of_contact(case: &Case, sampler: &mut Sampler, _: &mut crate::Tally) {
    let with_layer = sampler.chance(0.3).then(|| layer::random(case, sampler));
    let contact = with_layer.as_ref().map_or(&case.contact, |layered| &layered.contact);
    let (slip, slip_force) = (contact.slip_displacement, contact.slip_force);
    let kind = sampler.below(OF_CONTACTS);
    let path = histories::of_contact(sampler, slip, kind, 500);
    let [mut one, mut mirrored] = [(); 2].map(|()| call::state(ENOUGH));
    let mut from = 0.0;
    for (i, &u) in path.iter().enumerate() {
        let [force, stiffness, dissipated] = call::update(contact, &mut one, u);
        let context =
            || format!("layer {:?}, step {i} of {:?}", with_layer.as_ref().map(|one| one.reference.input), &path[..=i]);
        assert!(force.abs() <= slip_force, "Coulomb's bound {slip_force:e}: {force:e}; {}", context());
        // The stiffness of a branch has the error of its curve.
        let stiffest = contact.initial_stiffness * (1.0 + 1e-14);
        assert!(stiffness >= 0.0 && stiffness <= stiffest, "stiffness {stiffness:e}; {}", context());
        // At most the energy of gross slip over the whole step, and the rounding of all branches and displacements.
        let branches = (used(&one) + 2) as f64 * 1e-13 * contact.slip_energy;
        let most = slip_force * ((u - from).abs() + 4.0 * f64::EPSILON * (u.abs() + from.abs())) + branches;
        assert!(dissipated >= 0.0 && dissipated <= most, "dissipated {dissipated:e}; {}", context());
        let opposite = call::update(contact, &mut mirrored, -u);
        assert!(opposite == [-force, stiffness, dissipated], "mirrored {opposite:?}; {}", context());
        // The shortest path to the same reversals gives the same state: closed loops leave no trace.
        if i < 20 || i % 32 == 0 || i + 1 == path.len() {
            let reversals = one[HEADER..].as_chunks::<PER_REVERSAL>().0[..used(&one)].iter().map(|[u, _, _]| *u);
            let first = reversals.clone().next().unwrap_or(u);
            let run_up = (one[3] != 0.0).then(|| first - one[3] * (4.0 * slip + first.abs()));
            let mut again = call::state(ENOUGH);
            let mut last = [0.0; 3];
            for u in run_up.into_iter().chain(reversals).chain([u]) {
                last = call::update(contact, &mut again, u);
            }
            let length = HEADER + PER_REVERSAL * used(&one);
            let same = one[..length]
                .iter()
                .zip(&again)
                .all(|(one, again)| one.to_bits() == again.to_bits() || *one == 0.0 && *again == 0.0);
            assert!(same && last[..2] == [force, stiffness], "restarted {last:?}, {again:?}; {}", context());
        }
        from = u;
    }
}

/// A varying load.
pub fn of_element(case: &ElementCase, sampler: &mut Sampler, _: &mut crate::Tally) {
    let by_force = case.element.normal_input == microslip::ffi::MSLIP_INPUT_NORMAL_FORCE;
    let layered =
        sampler.chance(0.3).then(|| layer::random_input(&case.input, case.element.tangential_stiffness, sampler));
    let layered = layered.and_then(|input| Some((prepare(&input, by_force)?, input)));
    let with_layer =
        layered.map(|((element, reference), input)| ElementCase { element, reference, input, kind: case.kind });
    let case = with_layer.as_ref().unwrap_or(case);
    let element = &case.element;
    let mu = element.friction_coefficient;
    let unit = mu * (element.shift_under(element.normal_force) * element.tangential_stiffness + element.normal_force);
    let kind = sampler.below(OF_ELEMENTS);
    let path = histories::of_element(case, sampler, kind, 300);
    let [mut one, mut mirrored, mut short] = [ENOUGH, ENOUGH, 6].map(|pieces| vec![0.0; state::state_length(pieces)]);
    [&mut one, &mut mirrored, &mut short]
        .into_iter()
        .for_each(|memory| OneDirection::state_init(memory).expect("long enough"));
    let (mut farthest, mut largest): (f64, f64) = (0.0, 0.0);
    for (i, &to) in path.iter().enumerate() {
        let context = || format!("{:?}, step {i} of {:?}", case.input, &path[..=i]);
        let step = |memory: &mut Vec<f64>, to: [f64; 2]| {
            let (step, raised) = call::flags_of(|| OneDirection::step(element, memory, to));
            assert!(raised == 0, "exceptions {raised:#x}; {}", context());
            step.unwrap_or_else(|error| panic!("{error:?}; {}", context()))
        };
        let now = step(&mut one, to);
        let StepResult { force: [force, load], tangent, dissipated } = now;
        let finite = force.is_finite() && load.is_finite() && tangent.iter().all(|value| value.is_finite());
        assert!(finite && dissipated.is_finite() && dissipated >= 0.0, "{now:?}; {}", context());
        assert!(force.abs() <= mu * load, "Coulomb's bound: {now:?}; {}", context());
        assert!(
            OneDirection::force_error(&one) == 0.0 && OneDirection::state_check(&one).is_ok(),
            "merged or invalid; {}",
            context()
        );
        let opposite = step(&mut mirrored, [-to[0], to[1]]);
        let [by_u, zero, by_w, slope] = tangent;
        let mirror = ([-force, load], [by_u, zero, -by_w, slope], dissipated);
        assert!(
            (opposite.force, opposite.tangent, opposite.dissipated) == mirror,
            "mirrored {opposite:?}, {now:?}; {}",
            context()
        );
        // The reported error, and the rounding of displacements and loads so far.
        (farthest, largest) = (farthest.max(to[0].abs()), largest.max(load));
        let rounding = 1e-13 * (unit + mu * largest + farthest * element.tangential_stiffness);
        let merged = step(&mut short, to).force[0];
        let error = OneDirection::force_error(&short);
        assert!((merged - force).abs() <= error + rounding, "bounded {merged:e}, {error:e}: {now:?}; {}", context());
    }
}
