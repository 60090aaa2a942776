//! The program as its users call it, from a shell: results equal to those of the library, messages, pictures and files.

use microslip::constant_load::equivalents::{iwan, jenkins};
use microslip::constant_load::state::state_length;
use microslip::constant_load::{ConstantLoad, Law};
use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::{self as element_state, OneDirection};
use microslip::two_directions::TwoDirections;
use microslip::{Contact, EllipticParameters, Error, Material, Parameters};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_microslip");

/// A flat between different bodies; `$FLAT` in the shell.
const FLAT: &str = "--displacement-reference centre_point --flat-half-width 5e-5 --edge-radius 5e-3 --length 1e-2 \
                    --normal-force 150 --friction-coefficient 0.4 \
                    --young-modulus 2e11,114e9 --poisson-ratio 0.3,0.32";
/// The contact of `microslip example --elliptic`; `$ELLIPSE`.
const ELLIPSE: &str = "--semi-axis-x 0.2 --semi-axis-y 0.6 --normal-force 400 --friction-coefficient 0.5 --young-modulus 200e3 \
                       --poisson-ratio 0.3 --units mm";
/// The same flat as a parameter file; `flat.toml`.
const FLAT_TOML: &str = "flat_half_width = 5e-5\nedge_radius = 0.005\nlength = 0.01\nnormal_force = 150\n\
                         friction_coefficient = 0.4\ndisplacement_reference = \"centre_point\"\n\
                         [[material]]\nyoung_modulus = 2e11\npoisson_ratio = 0.3\n[[material]]\nyoung_modulus = 114e9\npoisson_ratio = 0.32\n";

fn material((young_modulus, poisson_ratio): (f64, f64)) -> Material {
    Material { young_modulus, poisson_ratio }
}

fn flat_parameters() -> Parameters {
    Parameters {
        flat_half_width: 5e-5,
        edge_radius: 5e-3,
        length: 1e-2,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [(2e11, 0.3), (114e9, 0.32)].map(material),
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    }
}

fn elliptic_parameters() -> EllipticParameters {
    EllipticParameters {
        semi_axis_x: 0.2,
        semi_axis_y: 0.6,
        normal_force: 400.0,
        friction_coefficient: 0.5,
        material: [(200e3, 0.3); 2].map(material),
        ..EllipticParameters::default()
    }
}

fn flat() -> Contact {
    Contact::rounded_flat(&flat_parameters()).unwrap()
}

fn ellipse() -> Contact {
    Contact::elliptic(&elliptic_parameters()).unwrap()
}

/// A shell in a directory of its own.
struct Shell(PathBuf);

impl Shell {
    fn new(name: &str) -> Shell {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(&directory).unwrap();
        let shell = Shell(directory);
        shell.write("flat.toml", FLAT_TOML);
        shell
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), content).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    fn run(&self, script: &str) -> Output {
        let function = format!("microslip() {{ '{PROGRAM}' \"$@\"; }}\n{script}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &function]).current_dir(&self.0).env("FLAT", FLAT).env("ELLIPSE", ELLIPSE).output().unwrap()
    }

    /// Standard output of a command without errors and warnings.
    fn stdout(&self, script: &str) -> String {
        let output = self.run(script);
        assert!(output.status.success() && output.stderr.is_empty(), "{script}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Checks that the command in the second line of a table gives the same table.
    fn check_repeated(&self, table: &str) {
        assert_eq!(self.stdout(table.lines().nth(1).unwrap().strip_prefix("# ").unwrap()), table);
    }

    /// Checks that a command fails with this exit status, a message that contains the text, and no other output.
    fn check_error(&self, script: &str, status: i32, text: &str) {
        let output = self.run(script);
        let is_reported = String::from_utf8_lossy(&output.stderr).contains(text);
        assert!(
            output.status.code() == Some(status) && is_reported && output.stdout.is_empty(),
            "{script}: {status} {text:?} expected: {output:?}"
        );
    }
}

/// Header and rows of a table.
fn cells(table: &str) -> (&str, Vec<Vec<&str>>) {
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    (lines.next().unwrap(), lines.map(|line| line.split(',').collect()).collect())
}

fn numbers(table: &str) -> Vec<Vec<f64>> {
    cells(table).1.iter().map(|row| row.iter().map(|cell| cell.parse().unwrap()).collect()).collect()
}

fn column(table: &str, index: usize) -> Vec<f64> {
    numbers(table).iter().map(|row| row[index]).collect()
}

/// Checks header, number of rows, and every number bit for bit.
fn assert_table(table: &str, header: &str, expected: &[Vec<f64>]) {
    let bits = |rows: &[Vec<f64>]| -> Vec<_> {
        rows.iter().map(|row| row.iter().map(|x| x.to_bits()).collect::<Vec<_>>()).collect()
    };
    assert_eq!(cells(table).0, header);
    assert!(bits(&numbers(table)) == bits(expected), "{table}\n{expected:?}");
}

#[test]
fn results_equal_those_of_the_library() {
    let shell = Shell::new("results");
    for (contact, given, [m, pa, k, j]) in
        [(flat(), "flat.toml", ["m", "Pa", "N/m", "J"]), (ellipse(), "$ELLIPSE", ["mm", "MPa", "N/mm", "mJ"])]
    {
        let stdout = |command: &str, options: &str| shell.stdout(&format!("microslip {command} {given} {options}"));
        let table = stdout("contact", "");
        let properties = [
            ("composite_modulus", contact.composite_modulus, pa),
            ("half_width", contact.half_width, m),
            ("slip_force", contact.slip_force, "N"),
            ("slip_displacement", contact.slip_displacement, m),
            ("initial_stiffness", contact.initial_stiffness, k),
            ("slip_energy", contact.slip_energy, j),
        ];
        assert_eq!((cells(&table).0, cells(&table).1.len()), ("quantity,value,unit", properties.len() + 1));
        for (row, (name, value, unit)) in cells(&table).1.iter().zip(properties) {
            assert_eq!((row[0], row[1].parse(), row[2]), (name, Ok(value), unit));
        }

        let slip = contact.slip_displacement;
        let header = format!("displacement [{m}],force [N],stiffness [{k}],stick_half_width [{m}]");
        let at_displacement = |displacement: f64| {
            let point = contact.curve_at_displacement(displacement).unwrap();
            vec![displacement, point.force(), point.stiffness(), point.stick_half_width()]
        };
        let at_force = |force: f64| {
            let point = contact.curve_at_force(force).unwrap();
            vec![point.displacement(), force, point.stiffness(), point.stick_half_width()]
        };
        for (options, expected) in [
            ("--points 3", [0.0, 0.5 * 1.25 * slip, 1.25 * slip].map(at_displacement)),
            ("--displacement -1e-7,1d-7,1", [-1e-7, 1e-7, 1.0].map(at_displacement)),
            ("--displacement '0.3, -2,0' --relative", [0.3 * slip, -2.0 * slip, 0.0].map(at_displacement)),
            ("--force -7,20,0", [-7.0, 20.0, 0.0].map(at_force)),
        ] {
            assert_table(&stdout("curve", options), &header, &expected);
        }

        let header = format!("amplitude [{m}],displacement [{m}],force [N],dissipated [{j}]");
        let expected = [0.5, 1.0, 1.5].map(|part| -> Vec<_> {
            let (amplitude, n) = (part * slip, 8);
            let hysteresis = contact.hysteresis_loop(amplitude).unwrap();
            let dissipated = contact.complex_stiffness(amplitude).unwrap().dissipated;
            (0..=n)
                .map(|i| vec![amplitude, hysteresis.displacement(i, n), hysteresis.force(i, n), dissipated])
                .collect()
        });
        assert_table(&stdout("loop", "--points 8"), &header, &expected.concat());
        assert_table(&stdout("loop", "--points 8 --amplitude 1 --relative"), &header, &expected[1]);

        let header =
            format!("amplitude [{m}],k_real [{k}],k_imag [{k}],dk_real [{k}^2],dk_imag [{k}^2],dissipated [{j}]");
        let complex = |amplitude: f64| {
            let k = contact.complex_stiffness(amplitude).unwrap();
            vec![amplitude, k.real, k.imaginary, k.d_real, k.d_imag, k.dissipated]
        };
        let jenkins_header = format!("amplitude [{m}],stiffness [{k}],slip_force [N]");
        let slider = |amplitude: f64| {
            let slider = jenkins(&contact, amplitude).unwrap();
            vec![amplitude, slider.stiffness, slider.slip_force]
        };
        for (options, [first, last]) in [
            ("--points 9", [0.01 * slip, 100.0 * slip]),
            ("--points 9 --from 1e-8 --to 3e-5", [1e-8, 3e-5]),
            ("--points 9 --from 1e-300 --to 1e150", [1e-300, 1e150]),
        ] {
            let grid = column(&stdout("stiffness", options), 0);
            assert_eq!((grid.len(), grid[0], grid[8]), (9, first, last));
            // Logarithms of up to 700, each rounded.
            assert!((grid[4] / (0.5 * (first.ln() + last.ln())).exp() - 1.0).abs() < 1e-12, "{grid:?}");
        }
        let amplitudes = [0.0, 1e-7, 2e-3];
        assert_table(&stdout("stiffness", "--amplitude 0,1e-7,2e-3"), &header, &amplitudes.map(complex));
        assert_table(&stdout("jenkins", "--amplitude 0,1e-7,2e-3"), &jenkins_header, &amplitudes.map(slider));

        let mut expected = Vec::new();
        let error = iwan(&contact, 7, |slider| {
            expected.push(vec![expected.len() as f64 + 1.0, slider.stiffness, slider.slip_force])
        });
        let table = stdout("iwan", "--count 7");
        assert_table(&table, &format!("slider [-],stiffness [{k}],slip_force [N]"), &expected);
        let remark = table.lines().find_map(|line| line.strip_prefix("# largest error of the force over mu N: "));
        assert_eq!(remark.map(str::parse), Some(Ok(error.unwrap())));

        let header = format!("force [N],x [{m}],pressure [{pa}],shear [{pa}]");
        let header = if m == "m" { format!("{header},slip [m],damage [N/m]") } else { header };
        let forces = [-10.0, 55.5];
        let x = [-contact.half_width, 0.0, 5e-5, contact.half_width];
        let row = |(force, x)| {
            let point = contact.curve_at_force(force).unwrap();
            let row = [force, x, contact.pressure(x), point.shear(x)].into_iter();
            row.chain(point.slip(x).ok()).chain(point.damage(x).ok()).collect()
        };
        let rows: Vec<Vec<f64>> = forces.into_iter().flat_map(|force| x.map(|x| row((force, x)))).collect();
        let options = format!("--force -10,55.5 --position {:e},0,5e-5,{:e}", x[0], x[3]);
        assert_table(&stdout("tractions", &options), &header, &rows);
        let default = numbers(&stdout("tractions", "--points 5"));
        let half = 0.5 * contact.slip_force;
        assert_eq!((default.len(), &default[0], &default[4]), (5, &row((half, x[0])), &row((half, x[3]))));
    }
}

#[test]
fn the_maximum_pressure_is_that_of_a_fine_grid() {
    let shell = Shell::new("pressure");
    let maximum =
        |given: &str| cells(&shell.stdout(&format!("microslip contact {given}"))).1[6][1].parse::<f64>().unwrap();
    // 3N/(2π b l), up to the rounding of the products.
    let of_ellipse = 3.0 * 400.0 / (2.0 * std::f64::consts::PI * 0.2 * 0.6);
    assert!((maximum("$ELLIPSE") / of_ellipse - 1.0).abs() < 1e-15);
    for flat in ["0", "1e-9", "5e-5", "1e-3"] {
        let given = format!("flat.toml --flat-half-width {flat}");
        let table = shell.stdout(&format!("microslip tractions {given} --points 20001"));
        let largest = column(&table, 2).into_iter().fold(0.0, f64::max);
        // The grid misses the maximum by at most 1/20000 of the width; the slope is zero there.
        let maximum = maximum(&given);
        assert!(maximum >= largest * (1.0 - 1e-15) && maximum < largest * (1.0 + 1e-5), "{flat}: {maximum} {largest}");
    }
}

/// Rows with the sum of their last column so far.
fn with_totals(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut total = 0.0;
    for row in &mut rows {
        total += row[row.len() - 1];
        row.push(total);
    }
    rows
}

#[test]
fn histories_equal_those_of_the_library() {
    let (shell, contact) = (Shell::new("histories"), flat());
    // A history with gross slip, and a spiral of 3000 nested reversals which the last step closes.
    let spiral = (0..3000).map(|i| 2.9e-7 * f64::from(i % 2 * 2 - 1) * (1.0 - f64::from(i) / 3001.0)).chain([2.93e-7]);
    let header = "displacement [m],force [N],stiffness [N/m],dissipated [J],dissipated_total [J]";
    for path in [vec![5e-7, -3e-7, 2e-7, -1e-7, 8e-7, 3e-6, 2.5e-6, 2.5e-6], spiral.collect()] {
        let n = path.len();
        let mut state = vec![0.0; state_length(n)];
        ConstantLoad::state_init(&mut state).unwrap();
        let rows = path.iter().map(|&to| {
            let step = ConstantLoad::step(&contact, &mut state, to).unwrap();
            vec![to, step.force, step.tangent, step.dissipated]
        });
        let expected = with_totals(rows.collect());
        shell.write("path.csv", path.iter().map(|displacement| format!("{displacement:e}\n")).collect::<String>());
        let table = shell.stdout("microslip history flat.toml < path.csv");
        assert_table(&table, header, &expected);
        // A table of results is a valid input.
        shell.write("table.csv", &table);
        for options in ["", "--column 1", "--column displacement"] {
            let command = format!("microslip history flat.toml --displacements table.csv {options}");
            assert_table(&shell.stdout(&command), header, &expected);
        }
        // All nested reversals are closed.
        let last = contact.curve_at_displacement(path[n - 1]).unwrap();
        assert!(n < 10 || expected[n - 1][1..3] == [last.force(), last.stiffness()]);
    }
    let relative = shell.stdout("printf 'u\n0.5\n-0.25\n' | microslip history flat.toml --relative");
    assert_eq!(column(&relative, 0), [0.5, -0.25].map(|part| part * contact.slip_displacement));
}

/// The displacements 1e-6 and -2e-6 as programs write them; if they are in another unit, the table states it.
#[test]
fn tables_of_other_programs_are_read() {
    let shell = Shell::new("tables");
    let labview = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n***End_of_Header***\t\n\t\n\
                   Channels\t2\t\nSamples\t2\t2\nDate\t2024/03/01\t2024/03/01\nY_Unit_Label\tum\tN\nX0\t0.0\t0.0\n\
                   ***End_of_Header***\t\t\nX_Value\tdisplacement\tforce\tComment\n0\t1\t5\n1\t-2\t6\n";
    let mts = "MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A\n\nData Header:\tTime:\t0.19\tSec\t1/23/2014 9:22:22 AM\n\
               Data Acquisition: Timed\nStation Name: rig 3\nTime\tDisplacement\tForce\nSec\tmm\tkN\n0.1\t0.001\t1\n0.2\t-0.002\t2\n";
    let meta = "Test,friction 12\nDate,2024-03-01\n17.03.2024,AB\n\n\"displacement\",\"force\"\n\"1e-6\",\"1,200.5\"\n\"-2e-6\",\"3\"\n";
    let of_blocks = "# u F\n  1.0E-06   3\n\n\n# second block\n -2.0E-06   4\n";
    for (table, options) in [
        ("\u{feff}u\r\n1e-6\r\n\n# c\n-2e-6", ""),
        ("# c\ntime [s], \"displacement [m]\"\n0,1e-6\n1, -2e-6\n", ""),
        ("t,u\n0,1e-6\n1,-2e-6\n", "--column u"),
        (" 1.0D-06\n-2.0d-06\n", ""),
        ("10000000000.0-016\n-2e-6\n", ""),
        // Decimal commas, also without a header.
        ("t;u\n0;0,000001\n0,5;-2E-06\n", "--column u"),
        ("0,0\t0,000001\n0,5\t-0,2e-5\n", "--column 2"),
        ("t, unit;u\n0.5;1e-6\n1.5;-2e-6\n", "--column u"),
        ("sep=;\r\nDisplacement (µm);Force (N)\r\n1,0;7\r\n-2,00;8\r\n", ""),
        ("0,1 0,000001\n0,2 -2e-6\n", "--column 2"),
        ("a;displacement\n1.234,5;1e-6\n1;-0,000002\n", ""),
        // Blanks.
        ("0.0 1e-6\n0.1 -2e-6\n", "--column 2"),
        ("# time displacement force\n0.0 1e-6 3\n0.1 -2e-6 4\n", ""),
        ("% displacement,force\n1e-6 3\n-2e-6 4\n", ""),
        ("! displacement [ um ]  force / N\n  1.0  3\n -2.0  4\n", ""),
        ("displacement force\n1e-6 2 # reversal\n-2e-6 3\n", ""),
        ("Normal Displacement   displacement   Axial Force\n  1.0 1e-6 3\n -2.0 -2e-6 4\n", ""),
        (of_blocks, "--column u"),
        // Units in a row, in brackets, in the name.
        ("Loop 17\ndisplacement,force\nµm,kN\n1,2\n-2,3\n", ""),
        ("displacement,force\n[um],[N]\n1,2\n-2,3\n", ""),
        ("displacement {mm},force {N}\n0.001,2\n-0.002,3\n", ""),
        ("t_s,x_um,F_N\n0,1,2\n1,-2,3\n", "--column x"),
        ("t_s,x_um,F_N\n0,1,2\n1,-2,3\n", "--column x_um"),
        ("t,Displacement / micrometres\n0,1\n1,-2\n", ""),
        ("m,N\n1e-6,2\n-2e-6,3\n", "--column 1"),
        ("x_s,displacement\n1,1e-6\n2,-2e-6\n", ""),
        ("displacement in µm;force - N\n1;2\n-2;3\n", ""),
        ("Displacement / (um) (filtered),force\n1,2\n-2,3\n", ""),
        ("displacement\tforce\nLVDT-1\tLC 5\nµm\tN\n1\t2\n-2\t3\n", ""),
        ("t;displacement\ns;µm\nfloat;float\n1;1\n2;-2\n", ""),
        // Thousands with decimal points or commas, marks of comments, text in the first column.
        ("x;displacement\n1 234,5;1e-6\n1'234,5;-2e-6\n", ""),
        ("force,displacement [nm]\n1,\"1,000\"\n2.5,\"-2,000\"\n", ""),
        ("* rig 3\n; 5 1 7\n* displacement, force\n1e-6, 2\n; pause\n-2e-6, 3\n", ""),
        ("REM displacement|force\n|1e-6|2|\n|-2e-6|3|\n", "--column 2"),
        ("state,displacement,force\nup,1e-6,2\ndown,-2e-6,3\n", ""),
        ("displacement;force\n1e-6;2;;\n-2e-6;3;;\n", ""),
        // Headers of programs, columns of other things, separators at the end of lines.
        (labview, ""),
        (mts, ""),
        (meta, ""),
        ("displacement,force,\n1e-6,2,\n-2e-6,3,\n", ""),
        ("displacement,force\n1e-6,2,\n-2e-6,3,\n", ""),
        (",displacement,force\n0,1e-6,2\n1,-2e-6,3\n", ""),
        ("date,displacement,state\n2024-03-01 12:00:00,1e-6,ok\n2024-03-01 12:00:01,-2e-6,end\n", ""),
        ("displacement,force\r1e-6,2\r\u{2212}2e-6,3\r", ""),
        ("7 rows\n650\ndisplacement\n1e-6\n-2e-6\n", "--skip 2"),
    ] {
        shell.write("table.csv", table);
        let command = format!("microslip history flat.toml --displacements table.csv {options}");
        let result = shell.stdout(&command);
        for (value, expected) in column(&result, 0).into_iter().zip([1e-6, -2e-6]) {
            // Two roundings: of the unit, and of the product.
            assert!((value / expected - 1.0).abs() < 3e-16, "{table}: {value}");
        }
        assert_eq!(numbers(&result).len(), 2, "{table}");
        shell.check_repeated(&result);
        let utf16: Vec<u8> = table.encode_utf16().flat_map(u16::to_le_bytes).collect();
        shell.write("table.csv", utf16);
        assert_eq!(shell.stdout(&command), result);
    }
    shell.write("table.csv", b"displacement [\xb5m]\n1\n-2\n");
    assert_eq!(column(&shell.stdout("microslip history flat.toml --displacements table.csv"), 0), [1e-6, -2e-6]);
    // What follows the rows is reported.
    shell.write("table.csv", "displacement,force\n1e-6,2\n-2e-6,3\nMax,1e-6\nstopped, 12:00\n");
    let result = shell.run("microslip history flat.toml --displacements table.csv");
    assert!(
        String::from_utf8_lossy(&result.stderr).contains("warning: line 4: \"Max,1e-6\" and what follows is no row")
    );
    assert_eq!(column(&String::from_utf8_lossy(&result.stdout), 0), [1e-6, -2e-6]);
}

/// Elements with one and with two directions, by normal force, by approach and, with two, under the force of the parameters.
#[test]
fn histories_of_elements_equal_those_of_the_library() {
    let shell = Shell::new("elements");
    // Sticking, slip, separation and gross slip; around a corner and back.
    let x = [0.0, 2e-7, -3e-7, 4e-7, 1e-6, 8e-7, -2e-7];
    let y = [1e-7, 3e-7, 3e-7, -2e-7, -1e-6, -1e-6, 4e-7];
    let force = Some([90.0, 200.0, 60.0, 0.0, 120.0, 30.0, 300.0]);
    let approach = Some([5e-7, 9e-7, 2e-7, -3e-7, 6e-7, 2e-7, 1e-6]);
    let (one, two) = (Directions::One, Directions::Two);
    let by_place_or_name = ["--column 3 --column-y 2", "--column displacement_x --column-y displacement_y"];
    // The header of the given table, in another order of the columns, which are found by name or given; that of the result.
    for (directions, input, values, given, header, options) in [
        (
            one,
            NormalInput::Force,
            force,
            "t,displacement,normal_force [N]",
            "displacement [m],normal_force [N],force [N],stiffness [N/m]",
            ["--normal-force-column 3", "--normal-force-column normal_force"],
        ),
        (
            one,
            NormalInput::Approach,
            approach,
            "t,displacement,approach [m]",
            "displacement [m],approach [m],normal_force [N],force [N],stiffness [N/m]",
            ["--approach-column 3", "--approach-column approach"],
        ),
        (
            two,
            NormalInput::Force,
            force,
            "t,displacement_y,displacement_x [m],normal_force [N]",
            "displacement_x [m],displacement_y [m],normal_force [N],force_x [N],force_y [N]",
            by_place_or_name,
        ),
        (
            two,
            NormalInput::Approach,
            approach,
            "t,displacement_y,displacement_x [m],approach [m]",
            "displacement_x [m],displacement_y [m],approach [m],normal_force [N],force_x [N],force_y [N]",
            by_place_or_name,
        ),
        (
            two,
            NormalInput::Force,
            None,
            "t,displacement_y,displacement_x [m]",
            "displacement_x [m],displacement_y [m],normal_force [N],force_x [N],force_y [N]",
            by_place_or_name,
        ),
    ] {
        let normal = values.unwrap_or([150.0; 7]);
        let element = Element::rounded_flat(&flat_parameters(), directions, input).unwrap();
        let mut memory = [vec![0.0; element_state::state_length(7)], vec![0.0; TwoDirections::STATE_LENGTH]];
        OneDirection::state_init(&mut memory[0]).unwrap();
        TwoDirections::state_init(&mut memory[1]).unwrap();
        let row = |i: usize| -> Vec<f64> {
            let given = if input == NormalInput::Approach { vec![normal[i]] } else { vec![] };
            if directions == one {
                let step = OneDirection::step(&element, &mut memory[0], [x[i], normal[i]]).unwrap();
                let results = [step.force[1], step.force[0], step.tangent[0], step.dissipated];
                [vec![x[i]], given, results.to_vec()].concat()
            } else {
                let step = TwoDirections::step(&element, &mut memory[1], [x[i], y[i], normal[i]]).unwrap();
                let [force_x, force_y, load] = step.force;
                assert!(force_x.hypot(force_y) <= 0.4 * load * (1.0 + 1e-12) && step.dissipated >= 0.0);
                [vec![x[i], y[i]], given, vec![load, force_x, force_y, step.dissipated]].concat()
            }
        };
        let expected = with_totals((0..7).map(row).collect());
        assert!(values.is_none() || expected.iter().any(|row| row[row.len() - 5] == 0.0));
        let rows = (0..7).map(|i| {
            let cells =
                [Some(i as f64), (directions == two).then_some(y[i]), Some(x[i]), values.map(|values| values[i])];
            cells.into_iter().flatten().map(|cell| format!("{cell:e}")).collect::<Vec<_>>().join(",") + "\n"
        });
        shell.write("given.csv", format!("{given}\n{}", rows.collect::<String>()));
        let header = format!("{header},dissipated [J],dissipated_total [J]");
        for options in [""].into_iter().chain(options) {
            let command = format!("microslip history flat.toml --displacements given.csv {options}");
            assert_table(&shell.stdout(&command), &header, &expected);
        }
        // A table of results is a valid input.
        shell.write("table.csv", shell.stdout("microslip history flat.toml --displacements given.csv"));
        assert_table(&shell.stdout("microslip history flat.toml --displacements table.csv"), &header, &expected);
    }
    let slip = flat().slip_displacement;
    shell.write("relative.csv", "displacement,displacement_y\n0.5,-0.25\n");
    let relative = shell.stdout("microslip history flat.toml --displacements relative.csv --relative");
    assert_eq!(numbers(&relative)[0][..3], [0.5 * slip, -0.25 * slip, 150.0]);
}

#[test]
fn the_normal_law_and_its_inverse_equal_those_of_the_library() {
    let shell = Shell::new("normal");
    let input = NormalInput::Approach;
    for (element, given, m, k) in [
        (Element::rounded_flat(&flat_parameters(), Directions::One, input), "flat.toml", "m", "N/m"),
        (Element::elliptic(&elliptic_parameters(), Directions::One, input), "$ELLIPSE", "mm", "N/mm"),
    ] {
        let element = element.unwrap();
        let header = format!("approach [{m}],normal_force [N],stiffness [{k}],half_width [{m}]");
        let at_approach = |part: f64| {
            let approach = part * element.approach;
            let point = element.normal_force_at(approach);
            vec![approach, point.value, point.slope, element.half_width_under(point.value)]
        };
        let at_force = |force: f64| {
            let point = element.approach_under(force);
            vec![point.value, force, 1.0 / point.slope, element.half_width_under(force)]
        };
        for (options, expected) in [
            ("--points 3", [0.0, 0.5, 1.0].map(at_approach)),
            ("--relative --approach -1,0.3,3", [-1.0, 0.3, 3.0].map(at_approach)),
            ("--force 1,150,900", [1.0, 150.0, 900.0].map(at_force)),
        ] {
            assert_table(&shell.stdout(&format!("microslip normal {given} {options}")), &header, &expected);
        }
        let open = numbers(&shell.stdout(&format!("microslip normal {given} --force 0")));
        assert_eq!(open, [[0.0; 4]]);
    }
}

#[test]
fn a_swinging_load_changes_the_energy_of_a_loop() {
    let shell = Shell::new("swinging");
    let cylinder = "flat.toml --flat-half-width 0";
    let run = |options: &str| shell.stdout(&format!("microslip loop {cylinder} {options}"));
    let swinging = |options: &str| numbers(&run(&format!("--relative --amplitude 0.8 {options}")));
    // At amplitude 0 it is the loop of the constant load, whose corners lie between the points of the walk.
    let still = swinging("--normal-amplitude 0 --phase 30 --points 8");
    let constant = numbers(&run("--relative --amplitude 0.8 --points 8"));
    assert_eq!(still.len(), constant.len());
    for (still, constant) in still.iter().zip(&constant) {
        assert_eq!((still[1], still[3], still[6]), (30.0, 150.0, constant[3]));
        assert!((still[2] - constant[1]).abs() < 1e-21 && (still[4] - constant[2]).abs() < 1e-12 * 60.0);
        assert!((still[5] / still[6] - 1.0).abs() < 1e-12, "{still:?}");
    }
    // The load is in phase with the displacement, then leads by a quarter of a period; beyond 1 the contact opens.
    let energy = |phase: &str| {
        let rows = swinging(&format!("--normal-amplitude 0.4 --phase {phase} --points 4"));
        let loads: Vec<_> = rows.iter().map(|row| row[3].round()).collect();
        (loads, rows[0][5] / rows[0][6])
    };
    let ((in_phase, least), (leading, most)) = (energy("0"), energy("-270"));
    assert_eq!(in_phase, [210.0, 150.0, 90.0, 150.0, 210.0]);
    assert_eq!(leading, [150.0, 90.0, 150.0, 210.0, 150.0]);
    assert!(least < most, "{least} {most}");
    let relative = swinging("--normal-amplitude 0.4 --phase 45");
    let amplitude = relative[0][0];
    assert_eq!(numbers(&run(&format!("--amplitude {amplitude} --normal-amplitude 60 --phase 45"))), relative);
}

/// Quantities of the table of a fit: value and status.
fn quantity<'a>(table: &'a str, name: &str) -> (f64, &'a str) {
    let rows = cells(table).1;
    let row = rows.iter().find(|row| row[0] == name).unwrap();
    (row[1].parse().unwrap(), row[5])
}

#[test]
fn a_fit_recovers_the_contact_of_its_loops() {
    let shell = Shell::new("fit");
    for amplitude in ["0.7", "1.5"] {
        shell.stdout(&format!("microslip loop flat.toml --relative --amplitude {amplitude} --out {amplitude}.csv"));
    }
    let measured = "--measured 0.7.csv,1.5.csv";
    let options = "--friction-coefficient 0.6 --flat-half-width 3e-5";
    let command =
        format!("microslip fit flat.toml {measured} {options} --fitted new.toml --json new.json --plot new.svg");
    let table = shell.stdout(&command);
    shell.check_repeated(&table);
    check_picture(&shell.0.join("new.svg"));
    let shape = 5e-5 / flat().half_width;
    for (name, expected) in [
        ("friction_coefficient", 0.4),
        ("contact_compliance", 1.0),
        ("total_compliance", 1.0 / flat().initial_stiffness),
        ("flat_half_width_over_half_width", shape),
    ] {
        let (value, status) = quantity(&table, name);
        // The loops have a reversal at a sample, and no noise.
        assert!((value / expected - 1.0).abs() < 1e-3 && status == "determined", "{name}: {value} {expected} {status}");
    }
    assert!(table.contains("# The shape is determined"), "{table}");
    // The fitted contact is a parameter file.
    assert!(shell.stdout("microslip contact new.toml").contains("initial_stiffness"));
    // Loops of a contact with a layer: the fitted one lies on them.
    let layer = "--tangential-compliance 4e-9";
    shell.stdout(&format!("for a in 0.7 1.5; do microslip loop flat.toml {layer} --amplitude $(awk \"BEGIN{{print 2e-6*$a}}\") --out l$a.csv; done"));
    shell.stdout(
        "microslip fit flat.toml --measured l0.7.csv,l1.5.csv --fix shape --fix contact_compliance --fitted layer.toml",
    );
    let layer = shell.read("layer.toml");
    let compliance = layer.lines().find_map(|line| line.strip_prefix("tangential_compliance = "));
    assert!((compliance.unwrap().parse::<f64>().unwrap() / 4e-9 - 1.0).abs() < 1e-4);
    let json: serde_json::Value = serde_json::from_str(&shell.read("new.json")).unwrap();
    assert_eq!(json["friction_coefficient"]["value"].as_f64(), Some(quantity(&table, "friction_coefficient").0));

    // The same in other units, without header, with a normal force for each table, and parameters that are fixed.
    for amplitude in ["0.7", "1.5"] {
        shell.stdout(&format!(
            "grep '^[0-9]' {amplitude}.csv | awk -F, '{{printf \"%s,%s,1:00:%06.3f PM\\n\", $3, 1e6*$2, NR/10}}' > um{amplitude}.csv"
        ));
    }
    let fixed = "--fix contact_compliance,shape --fix series_compliance=0";
    let columns = "--column 2 --force-column 1 --time-column 3 --data-units um,N --loads 150,150";
    let same = shell.stdout(&format!("microslip fit flat.toml --measured um0.7.csv,um1.5.csv {columns} {fixed}"));
    assert!((quantity(&same, "friction_coefficient").0 / 0.4 - 1.0).abs() < 1e-4, "{same}");
    for name in ["series_compliance", "contact_compliance", "flat_half_width_over_half_width"] {
        assert_eq!(quantity(&same, name).1, "fixed", "{name}");
    }
    for (arguments, status, text) in [
        ("--measured 0.7.csv --data-units um", 2, "two units are needed"),
        ("--measured 0.7.csv --data-units um,N", 1, "column displacement is in m, not in um"),
        ("--measured 0.7.csv --fix shape=1", 2, "shape has no value"),
        ("--measured 0.7.csv --loads 1,2", 2, "--loads has 2 values for 1 tables"),
        ("--measured um0.7.csv --column 2", 1, "line 1: no column is named force; the 3 columns have no names: select"),
        ("--measured 0.7.csv --fitted 0.7.csv", 2, "is an input and is not overwritten"),
        ("--measured 0.7.csv --fitted same --json same", 2, "cannot be the same file"),
        ("--measured 0.7.csv --column force --force-column displacement", 1, "column force is in N, not in m"),
    ] {
        shell.check_error(&format!("microslip fit flat.toml {arguments}"), status, text);
    }

    // One plateau is lower by 20 %: there is a result, and an exit status of its own.
    for amplitude in ["0.7", "1.5"] {
        let lower = "/^[0-9]/ {print $2 \",\" ($3 > 0 ? 0.8 : 1) * $3}";
        let table = format!("(echo displacement,force; awk -F, '{lower}' {amplitude}.csv) > lower{amplitude}.csv");
        shell.stdout(&table);
    }
    let doubted = shell.run("microslip fit flat.toml --measured lower0.7.csv,lower1.5.csv --json doubted.json");
    let table = String::from_utf8(doubted.stdout).unwrap();
    assert!(
        doubted.status.code() == Some(3) && !table.contains("determined,") && !table.contains(",determined"),
        "{table}"
    );
    assert!(table.lines().nth(3).unwrap().starts_with("# The law does not explain these loops"), "{table}");
    assert_eq!(quantity(&table, "misfit_over_noise").1, "not_explained");
    let json: serde_json::Value = serde_json::from_str(&shell.read("doubted.json")).unwrap();
    let cause = &json["explanation"]["causes"][0];
    assert!(json["explanation"]["explained"] == false && cause["kind"] == "different_plateaus", "{json}");
    assert_eq!(cause["size"].as_f64(), Some(quantity(&table, "different_plateaus").0));
    assert!((cause["size"].as_f64().unwrap() + 0.2).abs() < 0.05, "{cause}");

    let warned = shell.run("microslip fit flat.toml --measured 1.5.csv --fix shape");
    assert!(String::from_utf8(warned.stderr).unwrap().contains("warning: one amplitude only"));
}

#[test]
fn layers_follow_from_measured_stiffnesses_and_from_the_roughness() {
    let shell = Shell::new("layer");
    // N/(0.45 h), with N_c = N/100.
    let table = shell.stdout("microslip layer flat.toml --rms-height 1e-6");
    let values: Vec<f64> = cells(&table).1.iter().map(|row| row[1].parse().unwrap()).collect();
    assert!((values[0] * 150.0 * 1.01 / 0.45e-6 - 1.0).abs() < 1e-14 && values[2..] == [1.5, 150.0], "{values:?}");
    assert!((values[1] / values[0] - 1.22).abs() < 0.02, "{values:?}");
    let initial = |contact: &str| -> f64 {
        let table = shell.stdout(&format!("microslip contact {contact}"));
        cells(&table).1.iter().find(|row| row[0] == "initial_stiffness").unwrap()[1].parse().unwrap()
    };
    let secant = |contact: &str| -> f64 {
        let table = shell.stdout(&format!("microslip curve {contact} --force 20"));
        20.0 / cells(&table).1[0][0].parse::<f64>().unwrap()
    };
    let under = |load: f64| format!("rough.toml --normal-force {load}");
    let rough = 1.0 / (1.0 / initial("flat.toml") + values[1]);
    // The comments of the table are lines of a parameter file, whose layer holds at another normal force.
    for (given, expected) in [
        ("--rms-height 1e-6", (rough, &initial as &dyn Fn(&str) -> f64, 150.0)),
        ("--measured-stiffness 3e7", (3e7, &initial, 150.0)),
        ("--measured-stiffness 3e7 --at 50", (3e7, &initial, 50.0)),
        ("--measured-stiffness 3e7 --at 100 --secant-force 20 --stiffening-load 7", (3e7, &secant, 100.0)),
        ("--measured-stiffness 2e7,3e7 --at 75,150", (3e7, &initial, 150.0)),
    ] {
        let table = shell.stdout(&format!("microslip layer flat.toml {given}"));
        shell.check_repeated(&table);
        let lines = table
            .lines()
            .filter_map(|line| line.strip_prefix("# ").filter(|line| line.contains("e = ") || line.contains("d = ")));
        let layer = lines.map(|line| format!("{line}\n")).collect::<String>();
        assert!(layer.lines().count() == 4 && table.contains("\n# p%layer = mslip_layer("), "{table}");
        shell.write("rough.toml", layer + &shell.read("flat.toml"));
        let (stiffness, found, load) = expected;
        // The displacement of the rest has 17 digits; the layer is a difference.
        assert!((found(&under(load)) / stiffness - 1.0).abs() < 1e-13, "{given}: {}", found(&under(load)));
    }
    for (arguments, status, text) in [
        ("", 2, "or --rms-height"),
        ("--rms-height -1", 2, "--rms-height must be finite and > 0"),
        ("--rms-height 1e300", 1, "normal_compliance of a layer must be"),
        ("--at 3", 2, "--measured-stiffness"),
        ("--measured-stiffness 3e7 --rms-height 1e-6", 2, "give --measured-stiffness of one or two loads"),
        ("--measured-stiffness 2e7,3e7", 2, "--at must have as many values"),
        ("--measured-stiffness 2e7,3e7 --at 75,150 --secant-force 1", 2, "for a single"),
        ("--measured-stiffness 3e7,2e7 --at 75,150", 1, "at most in proportion"),
        ("--measured-stiffness 3e12", 1, "no contact stiffer"),
        ("--measured-stiffness 3e7 --secant-force 100", 1, "mu N"),
    ] {
        shell.check_error(&format!("microslip layer flat.toml {arguments}"), status, text);
    }
}

#[test]
fn the_command_in_a_result_repeats_it() {
    let shell = Shell::new("repeat");
    shell.write("path's.csv", "0.5\n-1\n2");
    shell.write("two.csv", "u,N,v\n5e-7,1e-3,1e-7\n-2e-7,3e-4,2e-7\n4e-7,0,0\n");
    for example in ["example", "example --elliptic"] {
        shell.write("contact.toml", shell.stdout(&format!("microslip {example}")));
        for command in [
            "contact contact.toml",
            "tractions contact.toml --position 0,1e-4",
            "curve contact.toml --normal-force 12.5 --poisson-ratio 0.25,0.3",
            "curve contact.toml --displacement -1 --relative",
            "curve flat.toml --displacement-reference rigid_strip",
            "loop contact.toml",
            "stiffness contact.toml",
            "jenkins contact.toml",
            "iwan contact.toml",
            "history contact.toml --relative --displacements path\\'s.csv --column 1",
            "history contact.toml --displacements two.csv --column u --approach-column 2 --relative",
            "history contact.toml --displacements two.csv --column u --column-y v --approach-column N --relative",
            "history contact.toml --displacements two.csv --column u --column-y 2",
            "normal contact.toml --points 5",
            "loop contact.toml --points 4 --normal-amplitude 0.3 --phase 0,-45 --relative --amplitude 0.7",
        ] {
            let table = shell.stdout(&format!("microslip {command}"));
            shell.check_repeated(&table);
        }
    }
    let curves = ["contact.toml", "$ELLIPSE"].map(|given| shell.stdout(&format!("microslip curve {given}")));
    assert_eq!(result(&curves[0]), result(&curves[1]));
}

/// The lines after the command.
fn result(table: &str) -> Vec<&str> {
    table.lines().skip(2).collect()
}

#[test]
fn options_override_the_parameter_file() {
    let shell = Shell::new("override");
    let expected = shell.stdout("microslip curve $FLAT");
    assert_eq!(result(&shell.stdout("microslip curve - < flat.toml")), result(&expected));
    let other = FLAT_TOML.replace("= 150", "= 7").replace("= 0.4", "= 0.1").replace("poisson_ratio = 0.32\n", "");
    shell.write("other.toml", other);
    let options = "--normal-force 150 --friction-coefficient 0.4 --poisson-ratio 0.3,0.32";
    assert_eq!(result(&shell.stdout(&format!("microslip curve other.toml {options}"))), result(&expected));
    // One table stands for both bodies.
    shell.write("one.toml", FLAT_TOML.split_at(FLAT_TOML.rfind("[[material]]").unwrap()).0);
    let both = shell.stdout("microslip curve flat.toml --young-modulus 2e11 --poisson-ratio 0.3");
    assert_eq!(result(&shell.stdout("microslip curve one.toml")), result(&both));
}

#[test]
fn messages_name_the_error_and_what_is_allowed() {
    let shell = Shell::new("messages");
    shell.write("si.toml", "units = 'si'");
    for (arguments, before, error, after) in [
        ("curve flat.toml --edge-radius 0", "error: ", Error::BadEdgeRadius, ", not 0"),
        ("curve flat.toml --normal-force -1e-3", "error: ", Error::BadNormalForce, ", not -1e-3"),
        ("curve flat.toml --young-modulus 2e11,nan", "error: ", Error::BadYoungModulus, ", not 2e11,NaN"),
        ("curve flat.toml --length 1e-6", "error: ", Error::LengthTooShort, ", not 1e-6"),
        ("tractions $FLAT --force 61", "--force 61: ", Error::ForceExceedsSlip, ", which is 60 N"),
        ("curve $FLAT --displacement 1e151", "--displacement 1e151: ", Error::BadDisplacement, ""),
        ("curve $FLAT --to nan", "--to NaN: ", Error::BadDisplacement, ""),
        ("loop $FLAT --amplitude 1e-6,-1", "--amplitude -1: ", Error::BadAmplitude, ""),
        ("jenkins $FLAT --from 1 --to 1e200", "--to 1e200: ", Error::BadAmplitude, ""),
        ("iwan $FLAT --count 0", "--count 0: ", Error::BadCount, ""),
        ("normal $FLAT --force 10,-2", "--force -2: ", Error::BadNormalForce, ""),
        ("normal $FLAT --to 1", "--to 1: ", Error::LengthTooShort, ""),
        ("loop $FLAT --phase 0 --normal-amplitude -7.5", "--normal-amplitude -7.5: ", Error::BadForceAmplitude, ""),
    ] {
        shell.check_error(&format!("microslip {arguments}"), 1, &format!("{before}{error}{after}"));
    }
    for (status, arguments, text) in [
        (1, "stiffness flat.toml --normal-force 0", "give --from and --to, or --amplitude"),
        (1, "curve $FLAT --semi-axis-x 1", "parameters of two shapes"),
        (1, "contact no-such-file.toml", "no-such-file.toml: No such file"),
        (1, "contact $ELLIPSE si.toml", "--units differs from the units of the parameter file"),
        (1, "history $FLAT --displacements /", "/: Is a directory"),
        (1, "normal flat.toml --normal-force 0", "normal_force must be > 0"),
        (1, "loop $FLAT --phase 0,400 --normal-amplitude 1", "--phase 400: must be -360 to 360"),
        (1, "curve $FLAT --to -1", "--to -1: must be 0 or more"),
        // An error may be the consequence of other units.
        (
            1,
            "curve flat.toml --flat-half-width 0.2",
            "; flat_half_width = 0.2 m is implausible: a flank is at most 0.2 m",
        ),
        (2, "loop $FLAT --normal-amplitude 10", "--phase <DEGREES>"),
        (
            2,
            "loop $FLAT --normal-amplitude 4O --phase 0",
            "invalid value '4O' for '--normal-amplitude <N>': not a number",
        ),
        (2, "", "Usage: microslip <COMMAND>"),
        (
            2,
            "contact ${FLAT%--poi*}",
            "missing parameters: poisson_ratio; give them in a parameter file or by --poisson-ratio",
        ),
        (2, "contact", "--flat-half-width, --edge-radius, --length, --displacement-reference, --normal-force, --fric"),
        (2, "contact ${FLAT#* * }", "displacement_reference is rigid_strip for the contact of a machine, centre_point"),
        (2, "curve $FLAT --poison-ratio 0.3", "a similar argument exists: '--poisson-ratio'"),
        (2, "curve flat.toml --young-modulus 1,2,3", "a contact has two bodies"),
        (
            2,
            "stiffness $FLAT --from 2 --to 1",
            "0 < --from <= --to is required, not 2 and 1\n\nUsage: microslip stiffness [",
        ),
        (2, "curve $FLAT --plot picture.pdf", "--plot picture.pdf: the extension must be .svg or .png"),
        (2, "curve flat.toml --length 0,01", "the decimal separator is a point"),
        (2, "loop $FLAT --amplitude 5e-7, 1e-6", "lists are written without blanks, or in quotes"),
        (2, "history - --displacements -", "standard input cannot be both"),
    ] {
        shell.check_error(&format!("microslip {arguments}"), status, text);
    }
    for (options, text, count) in [
        ("flat.toml --edge-radius 1e-5", "edge_radius = 1e-5 m is below flat_half_width", 1),
        ("flat.toml --length 2e-4", "length = 2e-4 m is below two widths", 1),
        ("flat.toml --length 0.1", "", 0),
        ("flat.toml --length 10", "length = 10 m is implausible", 1),
        ("flat.toml --length 0.1 --normal-force 1e7", "normal_force = 1e7 N is implausible: b - a > R/4", 1),
        ("--semi-axis-x 0.01 ${ELLIPSE#--semi-axis-x 0.2}", "normal_force = 400 N is implausible: the semi-axes", 1),
        // Millimetres as metres, and pascals as megapascals.
        ("flat.toml --units mm", "young_modulus = 2e11,1.14e11 MPa is implausible", 3),
        ("--semi-axis-x 200 ${ELLIPSE#--semi-axis-x 0.2}", "semi_axis_x = 200 mm is implausible", 1),
        ("flat.toml --friction-coefficient 50", "friction_coefficient = 50 is implausible", 1),
    ] {
        let output = shell.run(&format!("microslip contact {options}"));
        let warning = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && !output.stdout.is_empty());
        assert!(warning.contains(text) && warning.lines().count() == count, "{options}: {warning}");
    }
}

#[test]
fn errors_in_files_name_file_and_line() {
    let shell = Shell::new("errors");
    let example = shell.stdout("microslip example");
    for (from, to, text) in [
        ("edge_radius", "radious", "unknown field `radious`, expected one of `flat_half_width`, `edge_radius`, "),
        ("poisson_ratio", "length", "unknown field `length`, expected `young_modulus` or `poisson_ratio`"),
        ("\"si\"", "\"inch\"", "unknown variant `inch`, expected `si` or `mm`"),
        ("= 0.0 ", "= -1 ", &format!("{}, not -1", Error::BadFlatHalfWidth)),
        ("800", "'800'", "invalid type: string \"800\", expected f64"),
        ("[[material]]", "[[material]]\n[[material]]\n[[material]]", "at most two tables [[material]]"),
    ] {
        assert!(example.contains(from));
        shell.write("contact.toml", example.replace(from, to));
        shell.check_error("microslip contact contact.toml", 1, text);
        shell.check_error("microslip contact contact.toml", 1, "error: contact.toml: ");
    }
    for (table, options, text) in [
        (&b"1e-6\n1e-6m"[..], "", "line 2: \"1e-6m\": not a number"),
        (
            b"0.0 1e-6\n0.1 2e-6\n",
            "",
            "line 1: no column is named displacement; the 2 columns have no names: select one by --column NUMBER",
        ),
        (b"1 2 3\n1 2 3\n1e-6 2e-6\n1 2 3", "--column 3", "line 3: only 2 of 3 columns"),
        (b"u\n1,234\n", "", "line 2: a comma may separate columns or be the decimal separator"),
        (
            b"u;v\n1,234;2\n1,500;3\n",
            "--column 1",
            "line 2: \"1,234\" may have a decimal comma or a comma before thousands",
        ),
        (
            b"u;v\n1,5;2\n1,234.5;3\n",
            "--column 1",
            "line 3, column u: \"1,234.5\": not a number; other numbers have decimal commas",
        ),
        (
            b"650\n0 1e-6\n1 2e-6\n",
            "--column 2",
            "line 1: \"650\" has 1 columns, but line 2 has 2; --skip 1 leaves it out",
        ),
        (b"u [mil]\n1\n", "", "line 1: column u is in \"mil\", which is no unit of m, cm, mm, um, nm"),
        (b"u [N]\n1\n", "", "line 1: column u is in N, not in m"),
        (b"u\n1\nu\n2\n", "", "line 3: \"u\" is no row of the table, which starts in line 2; give each table a file"),
        (b"u [um]\n1.5um\n", "", "line 2: \"1.5um\": not a number; write its unit in the header"),
        (b"a,b\n1.5,2,3\n", "--column a", "line 2: no column a; the 3 columns have no names; line 1 has 2"),
        (b"u\n1\n2e-\n", "", "line 3: \"2e-\": not a number; is the file cut off?"),
        (b"\x89PNG\0\0", "", "this is no text"),
        (b"# c\nu\n1e-6\ninf", "", &format!("line 4: NaN: {}", Error::BadDisplacement)),
        (b"u\n0\n0,5e-6\n", "", "line 2: \"0\" has 1 columns, but line 3 has 2; is a comma the decimal separator?"),
        (b"t,u\n0\n", "--column u", "line 2: only 1 of 2 columns"),
        (
            b"0;1,5E-06\n0.5;1e-6\n",
            "--column 1",
            "line 2, column 1: \"0.5\": not a number; other numbers have decimal commas",
        ),
        (b"0,0000001\n0,0000002\n", "", "line 1: a comma may separate columns or be the decimal separator"),
        (
            b"t,u\n0,1\n",
            "",
            "line 1: no column is named displacement; the columns are t, u: select one by --column NAME or --column NUMBER",
        ),
        (b"t,u\n0,1\n", "--column w", "line 1: no column w; the columns are t, u, by their numbers 1 to 2"),
        (
            b"u,u [m]\n0,1\n",
            "--column u",
            "line 1: several columns are named u: select one by its number, --column NUMBER",
        ),
        (b"0,.1\n", "--column 3", "line 1: no column 3; the 2 columns have no names, by their numbers 1 to 2"),
        (b"", "", "the table has no displacements"),
        (b"t,u\n0,1\n0,x\n", "--column u", &format!("line 3, column u: NaN: {}", Error::BadDisplacement)),
        (b"displacement,normal_force\n0,1\n0,-2\n", "", "line 3, column normal_force: -2: normal_force must be"),
        (b"displacement,approach\n0,1\n", "", "line 2, column approach: 1: length too small for the half-width"),
        (b"u,N\n0,1\n", "--column u --approach-column u", "line 1: --column and --approach-column select the same"),
        (
            b"u,v,N\n0,1,2\n",
            "--column u --column-y v --normal-force-column v",
            "line 1: --column-y and --normal-force-column select the same column",
        ),
        (b"displacement,displacement_y\n0,0\n0,inf\n", "", "line 3, column displacement_y: NaN: a displacement must"),
        (
            b"displacement_x,displacement_y,normal_force\n0,0,1\n0,1,-2\n",
            "",
            "line 3, column normal_force: -2: normal_force must be",
        ),
    ] {
        shell.write("table.csv", table);
        let text = format!("table.csv: {text}");
        shell.check_error(&format!("microslip history flat.toml --displacements table.csv {options}"), 1, &text);
        let text = text.replace("table.csv", "standard input");
        shell.check_error(&format!("microslip history flat.toml {options} < table.csv"), 1, &text);
    }
}

/// Checks that a picture is complete, and that the lines of an SVG are inside of it.
fn check_picture(path: &Path) {
    let bytes = fs::read(path).unwrap();
    assert!((5_000..1_000_000).contains(&bytes.len()), "{}", bytes.len());
    if path.extension().unwrap() == "png" {
        let size = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        return assert!(bytes.starts_with(b"\x89PNG") && size(16) >= 1400 && size(20) >= 872);
    }
    let text = String::from_utf8(bytes).unwrap();
    let size = |name| text.split(name).nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap();
    let [width, height] = ["width=\"", "height=\""].map(size);
    assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"));
    let paths = text.split(" d=\"").skip(1).flat_map(|rest| rest.split('"').next().unwrap().split(['M', 'L']).skip(1));
    for point in paths.map(|point| point.split_once(' ').unwrap()) {
        let inside = |value: &str, end: f64| (0.0..=end).contains(&value.parse().unwrap());
        assert!(inside(point.0, width) && inside(point.1, height), "{point:?}: {text}");
    }
}

#[test]
fn every_command_draws() {
    let shell = Shell::new("pictures");
    let draw = |command: &str, name: &str| {
        let _ = fs::remove_file(shell.0.join(name));
        shell.stdout(&format!("microslip {command} --plot {name}"));
        check_picture(&shell.0.join(name));
    };
    for given in ["flat.toml", "$ELLIPSE", "flat.toml --normal-force 0"] {
        for command in [
            "contact",
            "tractions --force 0",
            "curve",
            "loop",
            "stiffness --from 1e-9 --to 1e-3",
            "iwan",
            "jenkins --amplitude 1",
        ] {
            draw(&format!("{command} {given}"), "picture.svg");
        }
        draw(&format!("stiffness --amplitude 0,1e-7,1e-6 {given}"), "picture.SVG");
    }
    // Between two rows a picture follows the branch; one of many rows is bounded.
    shell.write("one.csv", "1e-6\n");
    shell.write("two.csv", "1e-6\n-1e-6\n");
    let row = |i: i32| format!("{}\n", 2.9e-7 * f64::from(i % 2 * 2 - 1) * (1.0 - 1e-5 * f64::from(i)));
    shell.write("spiral.csv", (0..100_000).map(row).collect::<String>());
    for (table, picture) in [("one.csv", "one.png"), ("two.csv", "two.svg"), ("spiral.csv", "spiral.svg")] {
        draw(&format!("history flat.toml --displacements {table}"), picture);
    }
    assert!(shell.read("two.svg").matches('L').count() > 200);
    shell.write("varying.csv", "displacement,approach\n0,4e-7\n5e-7,1e-6\n-4e-7,-5e-7\n8e-7,1e-6\n");
    let two = (0..20_000).map(|i| format!("{},{}\n", row(i).trim(), (7 * i) % 150)).collect::<String>();
    shell.write("spiral2.csv", format!("displacement,normal_force\n{two}"));
    draw("history flat.toml --displacements varying.csv", "varying.svg");
    draw("history flat.toml --displacements spiral2.csv", "forces.svg");
    let turn = |i: i32| f64::from(i).to_radians();
    let ellipse = (0..720).map(|i| format!("{},{},{}\n", turn(i).cos(), 0.1 * turn(i).sin(), turn(i + 40).sin() + 0.8));
    shell.write("orbit.csv", format!("displacement_x,displacement_y,approach\n{}", ellipse.collect::<String>()));
    shell.write("line.csv", "displacement_x,displacement_y\n1,0\n-1,0\n");
    shell.write("point.csv", "displacement_x,displacement_y\n0,0\n");
    for given in ["flat.toml", "flat.toml --flat-half-width 0 --friction-coefficient 0", "$ELLIPSE"] {
        for (table, picture) in [("orbit.csv", "orbit.svg"), ("line.csv", "line.svg"), ("point.csv", "point.png")] {
            draw(&format!("history {given} --displacements {table} --relative"), picture);
        }
        draw(&format!("normal {given}"), "normal.svg");
        draw(&format!("loop {given} --normal-amplitude 195 --phase 0,90 --amplitude 1e-6"), "swinging.svg");
    }
    draw("loop flat.toml --amplitude 1e-6,2e-6", "loop.svg");
    for text in
        ["displacement [µm]", "force [N]", "±1.00 µm, ", "a = 50.0 µm, R = 5.00 mm, L = 10.0 mm, N = 150 N, μ = 0.4"]
    {
        assert!(shell.read("loop.svg").contains(text), "{text}");
    }
}

#[test]
fn outputs_are_complete_and_inputs_are_not_overwritten() {
    let shell = Shell::new("outputs");
    let (curve, contact) = (shell.stdout("microslip curve flat.toml"), shell.stdout("microslip contact flat.toml"));
    assert_eq!(shell.stdout("microslip curve flat.toml --out table.csv --plot picture.svg"), "");
    assert_eq!(shell.stdout("microslip curve flat.toml --out -"), curve);
    for (status, command, text) in [
        (1, "tractions flat.toml --force 61 --out table.csv", "--force 61: "),
        (2, "curve flat.toml --out ./flat.toml", "flat.toml is an input and is not overwritten"),
        (2, "history flat.toml --displacements table.csv --out table.csv", "is an input and is not overwritten"),
        (2, "curve flat.toml --out picture.svg --plot picture.svg", "two outputs cannot be the same file"),
        (1, "curve flat.toml --out no/such/place.csv", "no/such/place.csv: No such file"),
        (1, "curve flat.toml --out .", ".: Is a directory"),
    ] {
        shell.check_error(&format!("microslip {command}"), status, text);
    }
    assert_eq!((shell.read("table.csv"), shell.read("flat.toml")), (curve, FLAT_TOML.to_owned()));
    // A reader may close its end of the pipe.
    let pipe = shell.run("{ microslip curve flat.toml --points 100000; echo $? >&2; } | true");
    assert_eq!(pipe.stderr, b"0\n");
    if cfg!(target_os = "linux") {
        shell.check_error("microslip contact flat.toml > /dev/full", 1, "standard output: No space left");
        let pipe =
            "mkfifo pipe; timeout 10 cat pipe & microslip contact flat.toml --out pipe; wait; test -p pipe && rm pipe";
        assert_eq!(shell.stdout(pipe), contact);
        // Links are followed; an existing file keeps its permissions, and a new one has those of the umask.
        let modes = "umask 027; echo old > private.csv; chmod 600 private.csv; ln -s private.csv link.csv; \
                     microslip contact flat.toml --out link.csv; microslip contact flat.toml --out new.csv; stat -c '%a %F' *.csv";
        assert_eq!(shell.stdout(modes), "777 symbolic link\n640 regular file\n600 regular file\n644 regular file\n");
        assert_eq!((shell.read("private.csv"), shell.read("new.csv")), (contact.clone(), contact));
        // A full disk is reported. A signal during writing leaves no temporary file.
        let full = "trap '' XFSZ; ulimit -f 1; microslip loop flat.toml --out full.csv";
        shell.check_error(full, 1, "full.csv: File too large (os error 27); the file is incomplete");
        assert!(!shell.run("ulimit -f 1; microslip loop flat.toml --out full.csv").status.success());
        let files = "flat.toml full.csv link.csv new.csv picture.svg private.csv table.csv ";
        assert_eq!(shell.stdout("ls -A | tr '\n' ' '"), files);
    }
}

#[test]
fn input_without_end_is_an_error() {
    let shell = Shell::new("limits");
    for (script, text) in [
        ("yes 1e-6 | microslip history flat.toml", "standard input: longer than 200 MB"),
        ("yes 1e-6 | microslip fit flat.toml --measured -", "standard input: longer than 200 MB"),
        ("yes 1 | head -n 4000001 | microslip history flat.toml", "line 4000001: a table has at most 4000000 rows"),
        ("yes | microslip contact -", "standard input: longer than 1 MB"),
    ] {
        shell.check_error(script, 1, text);
    }
    if cfg!(target_os = "linux") {
        shell.check_error("microslip contact /dev/zero", 1, "/dev/zero: longer than 1 MB");
    }
}

#[test]
fn help_has_units_columns_and_an_example_for_each_command() {
    let shell = Shell::new("help");
    shell.write("contact.toml", shell.stdout("microslip example"));
    shell.write("measured.csv", "t,u,v,N\n0,1e-6,2e-7,300\n1,-1e-6,4e-7,500\n");
    for (i, force, amplitude) in [(1, 100, 0.7), (2, 200, 2.0)] {
        let table = format!(
            "microslip loop contact.toml --normal-force {force} --relative --amplitude {amplitude} | grep '^[0-9]'"
        );
        shell.stdout(&format!(
            "(echo 'displacement [um],force [N]'; {table} | awk -F, '{{print 1e6*$2 \",\" $3}}') > loop{i}.csv"
        ));
        shell.stdout(&format!("(echo x,F,N; {table} | awk -F, '{{print $2 \",\" $3 \",{force}\"}}') > rig{i}.csv"));
    }
    let general = shell.stdout("microslip --help");
    for text in ["m, N, Pa, N/m, J", "mm, N, MPa, N/mm, mJ", "Exit status:", "microslip example > contact.toml"] {
        assert!(general.contains(text), "{text}");
    }
    for command in ["contact", "tractions", "curve", "loop", "stiffness", "history", "normal", "jenkins", "iwan", "fit"]
    {
        assert!(general.contains(&format!("\n  {command} ")), "{command}");
        let help = shell.stdout(&format!("microslip {command} --help"));
        for text in [
            "--edge-radius <m>",
            "--young-modulus <Pa>",
            "--normal-force <N>",
            "--plot <FILE",
            "[default: si]",
            "Units:",
        ] {
            assert!(help.contains(text), "{command}: {text}");
        }
        // The examples work, and their tables have the columns.
        let (before, examples) = help.split_once("Example:\n  ").unwrap();
        let columns = before.split_once("Columns:\n  ").unwrap().1;
        for example in examples.lines() {
            let table = shell.stdout(&example.replace("--out curve.csv", "--out -"));
            for name in cells(&table).0.split(',').map(|name| name.split(' ').next().unwrap()) {
                assert!(columns.contains(name), "{command}: {name}");
            }
        }
    }
    assert_eq!(shell.stdout("microslip --version"), format!("microslip {}\n", env!("CARGO_PKG_VERSION")));
}
