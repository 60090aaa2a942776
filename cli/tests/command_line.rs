//! The program as its users call it: its numbers against the library's, bit for bit, its refusals, its files.

use microslip::constant_load::equivalents::{iwan, jenkins};
use microslip::constant_load::masing::{self, PathOutput};
use microslip::constant_load::state::{state_init, state_length};
use microslip::{Contact, EllipticParameters, Error, Material, Parameters};
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::{TempDir, tempdir};

const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };
const TITANIUM: Material = Material { young_modulus: 114e9, poisson_ratio: 0.32 };

/// A flat of unlike bodies.
fn flat() -> (Contact, &'static str) {
    let parameters = Parameters {
        flat_half_width: 5e-5,
        edge_radius: 5e-3,
        length: 1e-2,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [STEEL, TITANIUM],
        ..Parameters::default()
    };
    let flags = "--flat-half-width 5e-5 --edge-radius 5e-3 --length 1e-2 --normal-force 150 --friction-coefficient 0.4 \
                 --young-modulus 2e11,114e9 --poisson-ratio 0.3,0.32";
    (Contact::rounded_flat(&parameters).unwrap(), flags)
}

/// The contact of `microslip example --elliptic`.
fn ellipse() -> (Contact, &'static str) {
    let material = [Material { young_modulus: 200e3, poisson_ratio: 0.3 }; 2];
    let parameters = EllipticParameters {
        semi_axis_x: 0.2,
        semi_axis_y: 0.6,
        normal_force: 400.0,
        friction_coefficient: 0.5,
        material,
    };
    let flags = "--semi-axis-x 0.2 --semi-axis-y 0.6 --normal-force 400 --friction-coefficient 0.5 --young-modulus 200e3 \
                 --poisson-ratio 0.3 --units mm";
    (Contact::elliptic(&parameters).unwrap(), flags)
}

const PROGRAM: &str = env!("CARGO_BIN_EXE_microslip");

fn microslip() -> Command {
    Command::new(PROGRAM)
}

/// What the program does with these words, split at spaces, and this standard input.
fn call_with(input: &[u8], words: &str) -> Output {
    let mut child = microslip()
        .args(words.split_whitespace())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // What is refused by its flags is not read.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

fn call(words: &str) -> Output {
    call_with(b"", words)
}

fn stdout_with(input: &[u8], words: &str) -> String {
    let output = call_with(input, words);
    assert!(output.status.success() && output.stderr.is_empty(), "{words}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn stdout(words: &str) -> String {
    stdout_with(b"", words)
}

/// The header and the rows of a table.
fn cells(table: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(table.as_bytes());
    let cells = |record: csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let header = cells(reader.headers().unwrap().clone());
    (header, reader.records().map(|record| cells(record.unwrap())).collect())
}

fn numbers(table: &str) -> Vec<Vec<f64>> {
    let rows = cells(table).1;
    rows.iter().map(|row| row.iter().map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// Every row of the table has the bits expected, and so has their number.
fn assert_bits(table: &str, expected: &[Vec<f64>]) {
    let numbers = numbers(table);
    assert_eq!(numbers.len(), expected.len(), "{table}");
    for (row, expected) in numbers.iter().zip(expected) {
        let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(row), bits(expected), "{row:?} {expected:?}");
    }
}

fn column(table: &str, name: &str) -> Vec<f64> {
    let place = cells(table).0.iter().position(|header| header.split(' ').next() == Some(name)).unwrap();
    numbers(table).iter().map(|row| row[place]).collect()
}

#[test]
fn contact_gives_the_contact() {
    for ((contact, flags), units) in
        [(flat(), ["Pa", "m", "N", "N/m", "J"]), (ellipse(), ["MPa", "mm", "N", "N/mm", "mJ"])]
    {
        let (header, rows) = cells(&stdout(&format!("contact {flags}")));
        assert_eq!(header, ["quantity", "value", "unit"]);
        let [pressure, length, force, stiffness, energy] = units;
        let expected = [
            ("composite_modulus", contact.composite_modulus, pressure),
            ("half_width", contact.half_width, length),
            ("slip_force", contact.slip_force, force),
            ("slip_displacement", contact.slip_displacement, length),
            ("initial_stiffness", contact.initial_stiffness, stiffness),
            ("slip_energy", contact.slip_energy, energy),
        ];
        assert_eq!(rows.len(), expected.len() + 1);
        for (row, (name, value, unit)) in rows.iter().zip(expected) {
            assert_eq!(
                (row[0].as_str(), row[1].parse::<f64>().unwrap().to_bits(), row[2].as_str()),
                (name, value.to_bits(), unit)
            );
        }
        assert_eq!((rows[6][0].as_str(), rows[6][2].as_str()), ("maximum_pressure", pressure));
    }
}

#[test]
fn the_maximum_pressure_is_the_maximum() {
    let maximum = |flags: &str| cells(&stdout(&format!("contact {flags}"))).1[6][1].parse::<f64>().unwrap();
    // 3N/(2π b l), to the rounding of the products.
    let of_ellipse = 3.0 * 400.0 / (2.0 * std::f64::consts::PI * 0.2 * 0.6);
    assert!((maximum(ellipse().1) / of_ellipse - 1.0).abs() < 1e-15);
    for flat in ["0", "1e-9", "5e-5", "1e-3"] {
        let flags = format!("{} --flat-half-width {flat}", flat_without_width());
        let table = stdout(&format!("tractions {flags} --points 20001"));
        let largest = column(&table, "pressure").into_iter().fold(0.0, f64::max);
        let maximum = maximum(&flags);
        // The grid misses the maximum by a 20000th of the width at most, where it is flat.
        assert!(maximum >= largest * (1.0 - 1e-15) && maximum < largest * (1.0 + 1e-5), "{flat}: {maximum} {largest}");
    }
}

fn flat_without_width() -> String {
    flat().1.replace("--flat-half-width 5e-5 ", "")
}

#[test]
fn tractions_are_the_librarys() {
    let (contact, flags) = flat();
    let x = [-1e-5, 0.0, 5e-5, 1.2e-4, 1e-3];
    let mut expected = Vec::new();
    for force in [-10.0, 55.5] {
        let point = contact.curve_at_force(force).unwrap();
        let row =
            |x| vec![force, x, contact.pressure(x), point.shear(x), point.slip(x).unwrap(), point.damage(x).unwrap()];
        expected.extend(x.map(row));
    }
    let table = stdout(&format!("tractions {flags} --force -10,55.5 --position -1e-5,0,5e-5,1.2e-4,1e-3"));
    assert_eq!(cells(&table).0, ["force [N]", "x [m]", "pressure [Pa]", "shear [Pa]", "slip [m]", "damage [N/m]"]);
    assert_bits(&table, &expected);

    let (contact, flags) = ellipse();
    let table = stdout(&format!("tractions {flags} --force 0.25 --relative --points 5"));
    assert_eq!(cells(&table).0, ["force [N]", "x [mm]", "pressure [MPa]", "shear [MPa]"]);
    let force = 0.25 * contact.slip_force;
    let point = contact.curve_at_force(force).unwrap();
    let x = column(&table, "x");
    assert_eq!((x.len(), x[0], x[4]), (5, -contact.half_width, contact.half_width));
    assert_bits(&table, &x.iter().map(|&x| vec![force, x, contact.pressure(x), point.shear(x)]).collect::<Vec<_>>());
}

#[test]
fn the_curve_is_the_librarys() {
    for (contact, flags) in [flat(), ellipse()] {
        let at = |displacement: f64| {
            let point = contact.curve_at_displacement(displacement).unwrap();
            vec![displacement, point.force(), point.stiffness(), point.stick_half_width()]
        };
        let table = stdout(&format!("curve {flags} --points 11"));
        let grid = column(&table, "displacement");
        assert_eq!((grid.len(), grid[0], grid[10]), (11, 0.0, 1.25 * contact.slip_displacement));
        assert_bits(&table, &grid.into_iter().map(at).collect::<Vec<_>>());
        let table = stdout(&format!("curve {flags} --displacement -1e-7,1e-7,1"));
        assert_bits(&table, &[-1e-7, 1e-7, 1.0].map(at));
        let table = stdout(&format!("curve {flags} --displacement 0.3,-2 --relative"));
        assert_bits(&table, &[0.3, -2.0].map(|part| at(part * contact.slip_displacement)));
        let table = stdout(&format!("curve {flags} --force -7,20"));
        let at_force = |force: f64| {
            let point = contact.curve_at_force(force).unwrap();
            vec![point.displacement(), force, point.stiffness(), point.stick_half_width()]
        };
        assert_bits(&table, &[-7.0, 20.0].map(at_force));
    }
}

#[test]
fn loops_are_the_librarys_and_closed() {
    let (contact, flags) = flat();
    let mut expected = Vec::new();
    for amplitude in [3e-7, 2e-6] {
        let hysteresis = contact.hysteresis_loop(amplitude).unwrap();
        let dissipated = contact.complex_stiffness(amplitude).unwrap().dissipated();
        expected.extend(
            (0..=8).map(|i| vec![amplitude, hysteresis.displacement(i, 8), hysteresis.force(i, 8), dissipated]),
        );
    }
    let table = stdout(&format!("loop {flags} --amplitude 3e-7,2e-6 --points 8"));
    assert_eq!(cells(&table).0, ["amplitude [m]", "displacement [m]", "force [N]", "dissipated [J]"]);
    assert_bits(&table, &expected);
    assert_eq!(expected[0][1..], expected[8][1..]);

    let default = column(&stdout(&format!("loop {flags} --points 2")), "amplitude");
    assert_eq!(default, [0.5, 0.5, 0.5, 1.0, 1.0, 1.0, 1.5, 1.5, 1.5].map(|part| part * contact.slip_displacement));
}

#[test]
fn complex_stiffness_and_jenkins_are_the_librarys() {
    for (contact, flags) in [flat(), ellipse()] {
        let stiffness = |amplitude: f64| {
            let complex = contact.complex_stiffness(amplitude).unwrap();
            let slopes = [complex.d_real(), complex.d_imag(), complex.dissipated()];
            [vec![amplitude, complex.real(), complex.imaginary()], slopes.to_vec()].concat()
        };
        let slider = |amplitude: f64| {
            let slider = jenkins(&contact, amplitude).unwrap();
            vec![amplitude, slider.stiffness, slider.slip_force]
        };
        for (grid_flags, ends) in [
            ("", [0.01 * contact.slip_displacement, 100.0 * contact.slip_displacement]),
            ("--from 1e-8 --to 3e-5", [1e-8, 3e-5]),
            ("--from 1e-300 --to 1e150", [1e-300, 1e150]),
        ] {
            let table = stdout(&format!("stiffness {flags} {grid_flags} --points 9"));
            let grid = column(&table, "amplitude");
            assert_eq!((grid.len(), grid[0], grid[8]), (9, ends[0], ends[1]));
            let middle = (0.5 * (ends[0].ln() + ends[1].ln())).exp();
            // Logarithms of up to 700, each rounded.
            assert!((grid[4] / middle - 1.0).abs() < 1e-12, "{grid:?}");
            assert_bits(&table, &grid.iter().copied().map(stiffness).collect::<Vec<_>>());
            let table = stdout(&format!("jenkins {flags} {grid_flags} --points 9"));
            assert_bits(&table, &grid.into_iter().map(slider).collect::<Vec<_>>());
        }
        let amplitudes = [0.0, 1e-7, 2e-3];
        assert_bits(&stdout(&format!("stiffness {flags} --amplitude 0,1e-7,2e-3")), &amplitudes.map(stiffness));
        assert_bits(&stdout(&format!("jenkins {flags} --amplitude 0,1e-7,2e-3")), &amplitudes.map(slider));
    }
}

#[test]
fn a_history_is_the_librarys() {
    let (contact, flags) = flat();
    let path = [5e-7, -3e-7, 2e-7, -1e-7, 8e-7, 3e-6, 2.5e-6, 2.5e-6];
    let mut state = [0.0; state_length(8)];
    let (mut force, mut stiffness, mut dissipated) = ([0.0; 8], [0.0; 8], [0.0; 8]);
    state_init(&mut state).unwrap();
    let output =
        PathOutput { force: Some(&mut force), stiffness: Some(&mut stiffness), dissipated: Some(&mut dissipated) };
    masing::path(&contact, &mut state, &path, output);
    let expected: Vec<_> = (0..8).map(|i| vec![path[i], force[i], stiffness[i], dissipated[i]]).collect();

    let table = path.map(|displacement| format!("{displacement:e}\n")).concat();
    let answer = stdout_with(table.as_bytes(), &format!("history {flags}"));
    assert_eq!(cells(&answer).0, ["displacement [m]", "force [N]", "stiffness [N/m]", "dissipated [J]"]);
    assert_bits(&answer, &expected);
    // A table of the program is one that it reads.
    assert_bits(&stdout_with(answer.as_bytes(), &format!("history {flags}")), &expected);
    let third = stdout_with(answer.as_bytes(), &format!("history {flags} --column 1 --displacements -"));
    assert_bits(&third, &expected);
    let relative = stdout_with(b"u\n0.5\n-0.25\n", &format!("history {flags} --relative"));
    let parts = [0.5, -0.25].map(|part| part * contact.slip_displacement);
    assert_eq!(column(&relative, "displacement"), parts);
}

#[test]
fn iwan_is_the_librarys() {
    let (contact, flags) = flat();
    let mut expected = Vec::new();
    let error = iwan(&contact, 7, |slider| {
        expected.push(vec![expected.len() as f64 + 1.0, slider.stiffness, slider.slip_force])
    });
    let table = stdout(&format!("iwan {flags} --count 7"));
    assert_eq!(cells(&table).0, ["slider [-]", "stiffness [N/m]", "slip_force [N]"]);
    assert_bits(&table, &expected);
    let remark = table.lines().find_map(|line| line.strip_prefix("# largest error of the force over mu N: ")).unwrap();
    assert_eq!(remark.parse::<f64>().unwrap().to_bits(), error.unwrap().to_bits());
}

#[test]
fn the_examples_are_contacts_and_results_repeat() {
    let directory = tempdir().unwrap();
    for (example, reference) in [("example", None), ("example --elliptic", Some(ellipse().1))] {
        let file = directory.path().join("contact.toml");
        fs::write(&file, stdout(example)).unwrap();
        let file = file.display();
        if let Some(flags) = reference {
            assert_eq!(stdout(&format!("contact {file}")), stdout(&format!("contact {flags}")));
        }
        let path = directory.path().join("path's.csv");
        fs::write(&path, "0.5\n-1\n2").unwrap();
        let history = format!("history {file} --relative --displacements {}", path.display());
        let commands =
            ["contact", "tractions", "tractions --position 0,1e-4", "curve", "curve --force 3", "loop", "stiffness"];
        let more = ["stiffness --amplitude 1e-6", "jenkins", "iwan", "curve --displacement -1 --relative"];
        let mut commands: Vec<_> = commands.iter().chain(&more).map(|command| format!("{command} {file}")).collect();
        commands.extend([history, format!("curve {file} --normal-force 12.5 --poisson-ratio 0.25,0.3")]);
        if reference.is_none() {
            commands.push(format!("curve {file} --displacement-reference rigid_strip"));
        }
        for command in commands {
            let result = stdout(&command);
            let repeat = result.lines().nth(1).unwrap().strip_prefix("# microslip ").unwrap();
            let again = Command::new("sh").args(["-c", &format!("'{PROGRAM}' {repeat}")]).output().unwrap();
            assert_eq!(String::from_utf8(again.stdout).unwrap(), result, "{repeat}");
        }
    }
}

#[test]
fn a_parameter_file_says_what_flags_say_and_flags_override_it() {
    let text = "flat_half_width = 5e-5\nedge_radius = 0.005\nlength = 0.01\nnormal_force = 150\nfriction_coefficient = 0.4\n\
                [[material]]\nyoung_modulus = 2e11\npoisson_ratio = 0.3\n\
                [[material]]\nyoung_modulus = 114e9\npoisson_ratio = 0.32\n";
    let from_flags = stdout(&format!("curve {}", flat().1));
    assert_eq!(stdout_with(text.as_bytes(), "curve -"), from_flags);
    let other = text.replace("150", "7").replace("0.32", "0.4").replace("0.4\n", "0.1\n");
    let flags = "--normal-force 150 --friction-coefficient 0.4 --poisson-ratio 0.3,0.32";
    assert_eq!(stdout_with(other.as_bytes(), &format!("curve - {flags}")), from_flags);
    // One table stands for both bodies.
    let one = text.split_at(text.rfind("[[material]]").unwrap()).0;
    let both = stdout(&format!(
        "curve {} --young-modulus 2e11 --poisson-ratio 0.3",
        flat().1.split(" --young").next().unwrap()
    ));
    assert_eq!(stdout_with(one.as_bytes(), "curve -"), both);
}

#[test]
fn units_are_names() {
    let in_mm = "--flat-half-width 0.05 --edge-radius 5 --length 10 --normal-force 150 --friction-coefficient 0.4 \
                 --young-modulus 2e5,114e3 --poisson-ratio 0.3,0.32 --units mm";
    let (metres, millimetres) = (stdout(&format!("contact {}", flat().1)), stdout(&format!("contact {in_mm}")));
    let factors = [("Pa", "MPa", 1e6), ("m", "mm", 1e-3), ("N", "N", 1.0), ("N/m", "N/mm", 1e3), ("J", "mJ", 1e-3)];
    for (si, mm) in cells(&metres).1.iter().zip(&cells(&millimetres).1) {
        let (_, unit, factor) = factors.iter().find(|factor| factor.0 == si[2]).unwrap();
        let [si, value] = [si, mm].map(|row| row[1].parse::<f64>().unwrap());
        // A few roundings on the way to each.
        assert!(mm[2] == *unit && (value * factor / si - 1.0).abs() < 1e-14, "{mm:?}");
    }
}

/// Exit status, and the error in one piece.
fn refusal(input: &str, words: &str) -> (i32, String) {
    let output = call_with(input.as_bytes(), words);
    assert!(output.stdout.is_empty(), "{words}: {output:?}");
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn what_is_wrong_is_said() {
    let flat = flat().1;
    let without = |flag: &str| {
        let words: Vec<_> = flat.split_whitespace().collect();
        words.chunks(2).filter(|pair| pair[0] != flag).flatten().copied().collect::<Vec<_>>().join(" ")
    };
    let with = |flag: &str, value: &str| format!("curve {} {flag} {value}", without(flag));
    // The library's sentences, after the flag they are about.
    let sentences = [
        (with("--edge-radius", "0"), "--edge-radius 0: ", Error::BadEdgeRadius),
        (with("--normal-force", "-1e-3"), "--normal-force -1e-3: ", Error::BadNormalForce),
        (with("--young-modulus", "2e11,nan"), "--young-modulus 2e11,NaN: ", Error::BadYoungModulus),
        (with("--poisson-ratio", "0.6"), "--poisson-ratio 0.6: ", Error::BadPoissonRatio),
        (with("--length", "1e-6"), "--length 1e-6: ", Error::LengthTooShort),
        (with("--normal-force", "1e300"), "microslip: ", Error::OutOfRange),
        (format!("tractions {flat} --force 61"), "--force 61: ", Error::ForceExceedsSlip),
        (format!("curve {flat} --force inf"), "--force inf: ", Error::BadForce),
        (format!("curve {flat} --displacement 1e151"), "--displacement 1e151: ", Error::BadDisplacement),
        (format!("curve {flat} --to nan"), "--to NaN: ", Error::BadDisplacement),
        (format!("loop {flat} --amplitude 1e-6,-1"), "--amplitude -1: ", Error::BadAmplitude),
        (format!("stiffness {flat} --amplitude nan"), "--amplitude NaN: ", Error::BadAmplitude),
        (format!("jenkins {flat} --from 1 --to 1e200"), "--to 1e200: ", Error::BadAmplitude),
        (format!("iwan {flat} --count 0"), "--count 0: ", Error::BadCount),
        (format!("tractions {flat} --position inf"), "--position inf: ", Error::BadPosition),
    ];
    for (words, before, error) in sentences {
        let (code, text) = refusal("", &words);
        assert!(code == 1 && text.contains(&format!("{before}{error}")), "{words}: {code} {text}");
    }
    let cases = [
        (1, format!("tractions {flat} --force 61"), ", which is 60 N"),
        (
            1,
            format!("stiffness {} --normal-force 0", without("--normal-force")),
            "give --from and --to, or --amplitude",
        ),
        (1, format!("curve {flat} --semi-axis-x 1"), "some of both"),
        (1, format!("curve {} --displacement-reference rigid_strip", ellipse().1), "some of both"),
        (1, "contact no-such-file.toml".to_owned(), "no-such-file.toml: No such file"),
        // Usage.
        (2, String::new(), "Usage: microslip <COMMAND>"),
        (
            2,
            format!("curve {}", without("--length")),
            "a number is missing: length; give it in a parameter file or by --length",
        ),
        (
            2,
            "contact".to_owned(),
            "--flat-half-width, --edge-radius, --length, --normal-force, --friction-coefficient, --young",
        ),
        (2, "contact --semi-axis-x 1".to_owned(), "numbers are missing: semi_axis_y, normal_force,"),
        (2, format!("curve {flat} --poison-ratio 0.3"), "a similar argument exists: '--poisson-ratio'"),
        (2, format!("curve {flat} --points 1"), "1 is not in 2..="),
        (2, with("--young-modulus", "1,2,3"), "a contact has two bodies"),
        (2, format!("curve {flat} --force 1 --displacement 1"), "cannot be used with"),
        (2, format!("stiffness {flat} --from 2 --to 1"), "0 < --from <= --to is needed, not 2 and 1"),
        (2, format!("curve {flat} --plot picture.pdf"), "--plot picture.pdf: the name must end with .svg or .png"),
        (2, with("--length", "1O"), "invalid value '1O' for '--length <m>'"),
        (2, "history - --displacements -".to_owned(), "standard input cannot be both"),
    ];
    for (status, words, sentence) in cases {
        let (code, error) = refusal("", &words);
        assert!(code == status && error.contains(sentence), "{words}: {code} {error}");
    }
}

#[test]
fn what_is_wrong_in_a_file_is_said_with_its_name() {
    let directory = tempdir().unwrap();
    let file = directory.path().join("contact.toml");
    let example = stdout("example");
    for (from, to, sentence) in [
        ("edge_radius", "edge_radious", "unknown key edge_radious; did you mean edge_radius?"),
        ("young_modulus", "youngs_modulus", "unknown key youngs_modulus; did you mean young_modulus?"),
        ("friction_coefficient", "mu", "unknown key mu; keys are flat_half_width, "),
        ("poisson_ratio", "length", "unknown key length; it belongs outside of [[material]]"),
        ("units = \"si\"", "young_modulus = 1", "unknown key young_modulus; it belongs inside of [[material]]"),
        ("\"si\"", "\"inch\"", "unknown variant `inch`, expected `si` or `mm`"),
        ("0.1e-3", "-1", &Error::BadFlatHalfWidth.to_string()),
        ("50e-3", "nan", &Error::BadEdgeRadius.to_string()),
        ("800", "'800'", "invalid type: string \"800\", expected f64"),
        ("20e-3", "20e", "line 5"),
        ("[[material]]", "[[material]]\n[[material]]\n[[material]]", "at most two tables [[material]]"),
    ] {
        assert!(example.contains(from));
        fs::write(&file, example.replace(from, to)).unwrap();
        let (code, error) = refusal("", &format!("contact {}", file.display()));
        assert!(code == 1 && error.contains(sentence) && error.contains("contact.toml: "), "{to}: {code} {error}");
    }
    fs::write(&file, &example).unwrap();
    let (code, error) = refusal("", &format!("contact {} --units mm", file.display()));
    assert!(code == 1 && error.contains("the parameter file names other units"), "{code} {error}");
    for (path, sentence) in [
        ("1e-6\n1e-6m", "standard input: row 2: \"1e-6m\" is not a number"),
        ("u\n1e-6\ninf", &format!("row 3: {}", Error::BadDisplacement)),
        ("displacement [mm]\n1", "column displacement is in mm, not in m"),
        ("# nothing\n", "there are no displacements"),
    ] {
        let (code, error) = refusal(path, &format!("history {}", file.display()));
        assert!(code == 1 && error.contains(sentence), "{path}: {code} {error}");
    }
}

/// Whether a picture is one, by its first bytes.
fn assert_picture(path: &Path) {
    let bytes = fs::read(path).unwrap();
    if path.extension().unwrap().eq_ignore_ascii_case("svg") {
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.starts_with("<svg width=\"860\"") && text.trim_end().ends_with("</svg>"), "{text}");
        // Every corner of every line is inside.
        let size = |name: &str| text.split(name).nth(1).unwrap().split('"').nth(1).unwrap().to_owned();
        let corners: Vec<f64> = size("viewBox=").split(' ').map(|number| number.parse().unwrap()).collect();
        for points in text.split("points=\"").skip(1).map(|rest| rest.split('"').next().unwrap()) {
            for point in points.split_whitespace() {
                let (x, y) = point.split_once(',').unwrap();
                let inside = |value: &str, end: f64| (0.0..=end).contains(&value.parse().unwrap());
                assert!(inside(x, corners[2]) && inside(y, corners[3]), "{point}: {text}");
            }
        }
    } else {
        let info = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap().info().size();
        assert!(info.0 == 1720 && info.1 >= 872, "{info:?}");
    }
}

fn names(directory: &TempDir) -> Vec<String> {
    let names = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

#[test]
fn every_command_draws() {
    let directory = tempdir().unwrap();
    let picture = |name: &str| directory.path().join(name);
    let open = flat().1.replace("--normal-force 150", "--normal-force 0");
    for flags in [flat().1, ellipse().1, &open] {
        for command in [
            "contact",
            "tractions --force 0",
            "curve",
            "loop",
            "stiffness --from 1e-9 --to 1e-3",
            "jenkins --amplitude 1",
            "stiffness --amplitude 0,1e-7,1e-6",
            "iwan",
        ] {
            let svg = picture("picture.svg");
            stdout(&format!("{command} {flags} --plot {}", svg.display()));
            assert_picture(&svg);
            fs::remove_file(svg).unwrap();
        }
    }
    let png = picture("picture.png");
    let table = stdout_with(b"1e-6\n", &format!("history {} --plot {}", flat().1, png.display()));
    assert_eq!(numbers(&table).len(), 1);
    assert_picture(&png);

    // From one row to the next a history is drawn as the law goes, not along a chord.
    let svg = picture("history.SVG");
    stdout_with(b"1e-6\n-1e-6\n", &format!("history {} --plot {}", flat().1, svg.display()));
    assert_picture(&svg);
    let text = fs::read_to_string(&svg).unwrap();
    assert!(
        text.split("points=\"").any(|rest| rest.split('"').next().unwrap().split_whitespace().count() > 100),
        "{text}"
    );

    // The words and the lines of one of them.
    let svg = picture("loop.svg");
    stdout(&format!("loop {} --amplitude 1e-6,2e-6 --plot {}", flat().1, svg.display()));
    let text = fs::read_to_string(&svg).unwrap();
    for words in
        ["displacement [µm]", "force [N]", "±1.00 µm, ", "a = 50.0 µm, R = 5.00 mm, L = 10.0 mm, N = 150 N, μ = 0.4"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(text.matches("<polyline").count() > 20, "{text}");
}

#[test]
fn files_are_written_whole_or_not_at_all() {
    let directory = tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    let flat = flat().1;
    let table = path("table.csv");
    let out = call(&format!("curve {flat} --out {} --plot {}", table.display(), path("picture.svg").display()));
    assert!(out.status.success() && out.stdout.is_empty(), "{out:?}");
    assert_eq!(fs::read_to_string(&table).unwrap(), stdout(&format!("curve {flat}")));
    assert_eq!(names(&directory), ["picture.svg", "table.csv"]);

    // Refused: what was there stays.
    let (code, _) = refusal("", &format!("tractions {flat} --force 61 --out {}", table.display()));
    assert_eq!((code, fs::read_to_string(&table).unwrap()), (1, stdout(&format!("curve {flat}"))));
    let (code, error) = refusal("", &format!("curve {flat} --out {}/no/such/place.csv", directory.path().display()));
    assert!(code == 1 && error.contains("place.csv: "), "{error}");
    let (code, error) = refusal("", &format!("curve {flat} --out {}", directory.path().display()));
    assert!(code == 1 && error.contains(&format!("{}: ", directory.path().display())), "{error}");

    // Inputs are not overwritten, by whatever name.
    let parameters = path("contact.toml");
    fs::write(&parameters, stdout("example")).unwrap();
    let same = directory.path().join(".").join("contact.toml");
    for command in ["curve", "history"] {
        let (code, error) = refusal("1", &format!("{command} {} --out {}", parameters.display(), same.display()));
        assert!(code == 2 && error.contains("is an input and is not overwritten"), "{error}");
    }
    let history = format!("history {flat} --displacements {0} --out {0}", table.display());
    assert_eq!(refusal("", &history).0, 2);
    assert_eq!(refusal("", &format!("curve {flat} --out {0} --plot {0}", path("picture.svg").display())).0, 2);
    assert_eq!(fs::read_to_string(&parameters).unwrap(), stdout("example"));
    assert_eq!(names(&directory), ["contact.toml", "picture.svg", "table.csv"]);
}

#[cfg(target_os = "linux")]
#[test]
fn links_devices_and_permissions_are_respected() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let directory = tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    let flat = flat().1;
    fs::write(path("table.csv"), "old").unwrap();
    symlink(path("table.csv"), path("link.csv")).unwrap();
    stdout(&format!("curve {flat} --out {}", path("link.csv").display()));
    assert!(fs::symlink_metadata(path("link.csv")).unwrap().is_symlink());
    assert!(fs::read_to_string(path("table.csv")).unwrap().starts_with("# microslip"));
    // As any new file: readable as the umask says, not by its owner alone.
    File::create(path("usual")).unwrap();
    stdout(&format!("curve {flat} --out {}", path("new.csv").display()));
    let mode = |name: &str| fs::metadata(path(name)).unwrap().permissions().mode();
    assert_eq!(mode("new.csv"), mode("usual"));
    // What is no file is written to and not replaced.
    let script = format!(
        "mkfifo pipe && {{ timeout 10 cat pipe & '{PROGRAM}' contact {flat} --out pipe; wait; test -p pipe; }}"
    );
    let pipe = Command::new("sh").args(["-c", &script]).current_dir(directory.path()).output().unwrap();
    assert!(pipe.status.success(), "{pipe:?}");
    assert_eq!(String::from_utf8(pipe.stdout).unwrap(), stdout(&format!("contact {flat}")));
    // A disk that is full leaves what was there, and nothing else.
    let script = format!("trap '' XFSZ; ulimit -f 1; '{PROGRAM}' loop {flat} --out table.csv");
    let before = (fs::read(path("table.csv")).unwrap(), names(&directory));
    let full = Command::new("sh").args(["-c", &script]).current_dir(directory.path()).output().unwrap();
    let error = String::from_utf8(full.stderr).unwrap();
    assert!(full.status.code() == Some(1) && error.contains("table.csv: File too large"), "{error}");
    assert_eq!((fs::read(path("table.csv")).unwrap(), names(&directory)), before);
    let script = format!("'{PROGRAM}' contact {flat} > /dev/full");
    let full = Command::new("sh").args(["-c", &script]).output().unwrap();
    let error = String::from_utf8(full.stderr).unwrap();
    assert!(full.status.code() == Some(1) && error.contains("standard output: No space left"), "{error}");
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let mut child = microslip()
        .args(format!("curve {} --points 1000000", flat().1).split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

#[test]
fn help_names_units_and_flags() {
    let general = stdout("--help");
    for words in ["m, N, Pa, N/m, J", "mm, N, MPa, N/mm, mJ", "Exit status:", "microslip example > contact.toml"] {
        assert!(general.contains(words), "{words}");
    }
    for command in ["contact", "tractions", "curve", "loop", "stiffness", "history", "jenkins", "iwan"] {
        assert!(general.contains(&format!("\n  {command} ")), "{command}");
        let help = stdout(&format!("{command} --help"));
        for words in [
            "--edge-radius <m>",
            "--young-modulus <Pa>",
            "--normal-force <N>",
            "--plot <FILE.svg|FILE.png>",
            "[default: si]",
        ] {
            assert!(help.contains(words), "{command}: {words}");
        }
    }
    assert_eq!(stdout("--version"), format!("microslip {}\n", env!("CARGO_PKG_VERSION")));
}
