use microslip::varying_load::element::{Element, NormalInput};
use microslip::varying_load::state::{advance, state_init, state_length};
use microslip::{EllipticParameters, Material, Parameters};
use std::collections::HashMap;

#[test]
fn golden() {
    let text = std::fs::read_to_string(format!("{}/tests/golden/varying_load.csv", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<HashMap<&str, &str>> = lines.map(|l| names.iter().copied().zip(l.split(',')).collect()).collect();
    let mut histories: Vec<Vec<HashMap<&str, &str>>> = Vec::new();
    for row in rows {
        if row["step"] == "0" {
            histories.push(Vec::new());
        }
        histories.last_mut().unwrap().push(row);
    }
    let mut worst = [(0.0f64, String::new()), (0.0, String::new()), (0.0, String::new()), (0.0, String::new()), (0.0, String::new())];
    for history in &histories {
        let f = |row: &HashMap<&str, &str>, name: &str| row[name].parse::<f64>().unwrap();
        let row = &history[0];
        let material = [
            Material { young_modulus: f(row, "E1"), poisson_ratio: f(row, "nu1") },
            Material { young_modulus: f(row, "E2"), poisson_ratio: f(row, "nu2") },
        ];
        let input = if row["control"] == "N" { NormalInput::Force } else { NormalInput::Approach };
        let mu = f(row, "mu");
        let n_max = history.iter().map(|r| f(r, "N")).fold(0.0, f64::max);
        let u_max = history.iter().map(|r| f(r, "delta").abs()).fold(0.0, f64::max);
        let element = if row["a"] == "nan" {
            Element::elliptic(
                &EllipticParameters { semi_axis_x: f(row, "semi_x"), semi_axis_y: f(row, "semi_y"), normal_force: f(row, "N_ref"), friction_coefficient: mu, material },
                input,
            )
        } else {
            Element::rounded_flat(
                &Parameters {
                    flat_half_width: f(row, "a"), edge_radius: f(row, "R"), length: f(row, "L"),
                    normal_force: n_max, friction_coefficient: mu, material, displacement_reference: 0, reserved: 0,
                },
                input,
            )
        }
        .unwrap();
        let mut state = vec![0.0; state_length(64)];
        state_init(&mut state).unwrap();
        for row in history {
            let normal = if input == NormalInput::Force { f(row, "N") } else { f(row, "u_n") };
            let step = advance(&element, &mut state, [f(row, "delta"), normal], true).unwrap();
            let place = format!("{} {} {} {}", row["history"], row["contact"], row["pattern"], row["step"]);
            let mut check = |i: usize, got: f64, want: f64, scale: f64| {
                let e = (got - want).abs() / scale;
                if e.is_nan() || e > worst[i].0 {
                    worst[i] = (e, format!("{place}: {got:e} {want:e}"));
                }
            };
            check(0, step.force[0], f(row, "T"), mu * n_max);
            check(1, step.force[1], f(row, "N"), n_max);
            check(2, step.dissipated, f(row, "dissipated"), mu * n_max * u_max.max(1e-300));
            if row["dT_ddelta"] != "nan" {
                check(3, step.tangent[0], f(row, "dT_ddelta"), element.tangential_stiffness);
            }
            if row["dT_dun"] != "nan" {
                let want = f(row, "dT_dun") * if input == NormalInput::Force { if f(row, "dN_dun") == 0.0 {0.0} else {1.0 / f(row, "dN_dun")} } else { 1.0 };
                check(4, step.tangent[2], want, if input == NormalInput::Force { mu } else { mu * element.normal_stiffness });
            }
        }
    }
    for w in worst {
        println!("{w:?}");
    }
}
