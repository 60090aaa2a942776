//! Known parameters are recovered from computed loops.

mod common;
use common::*;
use microslip_fit::*;

fn report_of(series: f64, noise: [f64; 2], correlation: f64, seed: u64, samples: usize, options: &Options) -> Report {
    let contact = flat();
    let k = library_contact(&contact, 800.0).initial_stiffness;
    let mut random = Random::new(seed);
    let rigs = [0.7, 1.2, 2.0].map(|amplitude| Rig { series_compliance: series / k, amplitude, noise, correlation, samples, ..RIG });
    let loops: Vec<_> = rigs.iter().map(|rig| measured(&contact, rig, &mut random)).collect();
    fit(&contact, &loops, options).unwrap()
}

#[test]
fn explore() {
    let contact = flat();
    let law = library_contact(&contact, 800.0);
    let k = law.initial_stiffness;
    for (c, noise, corr, samples) in [(0.2, [1e-3, 0.0], 0.0, 120), (0.2, [1e-3, 1e-4], 0.0, 120), (0.2, [1e-3, 5e-4], 0.0, 120), (0.2, [1e-3, 1e-4], 0.7, 120), (20.0, [1e-2, 1e-3], 0.0, 120),(20.0, [1e-2, 1e-3], 0.7, 120)] {
        let truth = [0.5, c / k, 1.0, 0.1e-3 / law.half_width, (1.0 + c) / k];
        let started = std::time::Instant::now();
        let mut hits = [0; 5];
        let mut status = [[0; 4]; 5];
        let mut width = [0.0; 5];
        for seed in 0..200 {
            let report = report_of(c, noise, corr, seed, samples, &Options::default());
            let e = [report.friction_coefficient, report.series_compliance, report.contact_compliance, report.shape.unwrap(), report.total_compliance];
            for i in 0..5 {
                hits[i] += usize::from((e[i].lower..=e[i].upper.unwrap_or(f64::INFINITY)).contains(&truth[i]));
                status[i][e[i].status as usize] += 1;
                width[i] += 0.5*(e[i].upper.unwrap_or(0.0)-e[i].lower)/200.0/truth[i];
            }
        }
        println!("{c} {noise:?} {corr}: {hits:?} {status:?} {width:.4?} {:?}", started.elapsed()/200);
    }
}
