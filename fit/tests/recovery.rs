//! Known parameters are recovered from computed loops.

mod common;
use common::*;
use microslip_fit::*;

#[test]
fn explore() {
    let contact = flat();
    let law = library_contact(&contact, 800.0);
    let k = law.initial_stiffness;
    println!("b {:e} slip {:e} k {:e} a/b {}", law.half_width, law.slip_displacement, k, 0.1e-3/law.half_width);
    for (c, noise) in [(0.0, 0.0), (0.2, 0.001), (0.2, 0.003), (0.2,0.01), (1.0,0.003), (20.0, 0.01)] {
        let started = std::time::Instant::now();
        let mut random = Random::new(1);
        let rigs = [0.7, 1.2, 2.0].map(|amplitude| Rig { series_compliance: c / k, amplitude, noise: [noise, 0.1*noise], ..RIG });
        let loops: Vec<_> = rigs.iter().map(|rig| measured(&contact, rig, &mut random)).collect();
        let report = fit(&contact, &loops, &Options::default()).unwrap();
        println!("\nC k0 = {c} noise {noise}: {:?}", started.elapsed());
        println!("mu {:?}\nC*k {:?} {:?}\nkappa {:?}\nshape {:?}", report.friction_coefficient, report.series_compliance.value*k, report.series_compliance, report.contact_compliance, report.shape);
        println!("{:?}\n{:?}", report.law, report.spring_slider);
        for p in &report.profile { println!("  {:.3} {:.5} {}", p.shape, p.relative_rms, p.admitted); }
        println!("{:#?} {:?}", report.verdict, report.warnings);
    }
}
