//! The program as its users call it: results equal to those of the library, messages, and files.

use microslip::constant_load::equivalents::{iwan, jenkins};
use microslip::constant_load::masing::{self, PathOutput};
use microslip::constant_load::state::{state_init, state_length};
use microslip::{Contact, EllipticParameters, Error, Material, Parameters};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const PROGRAM: &str = env!("CARGO_BIN_EXE_microslip");

/// Options of a flat between different bodies.
const FLAT: &str = "--flat-half-width 5e-5 --edge-radius 5e-3 --length 1e-2 --normal-force 150 --friction-coefficient 0.4 \
                    --young-modulus 2e11,114e9 --poisson-ratio 0.3,0.32";
/// Options of the contact of `microslip example --elliptic`.
const ELLIPSE: &str = "--semi-axis-x 0.2 --semi-axis-y 0.6 --normal-force 400 --friction-coefficient 0.5 --young-modulus 200e3 \
                       --poisson-ratio 0.3 --units mm";

fn flat() -> Contact {
    Contact::rounded_flat(&Parameters {
        flat_half_width: 5e-5,
        edge_radius: 5e-3,
        length: 1e-2,
        normal_force: 150.0,
        friction_coefficient: 0.4,
        material: [(2e11, 0.3), (114e9, 0.32)]
            .map(|(young_modulus, poisson_ratio)| Material { young_modulus, poisson_ratio }),
        ..Parameters::default()
    })
    .unwrap()
}

fn ellipse() -> Contact {
    Contact::elliptic(&EllipticParameters {
        semi_axis_x: 0.2,
        semi_axis_y: 0.6,
        normal_force: 400.0,
        friction_coefficient: 0.5,
        material: [Material { young_modulus: 200e3, poisson_ratio: 0.3 }; 2],
    })
    .unwrap()
}

/// An empty directory for one test.
fn directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// Runs a shell command in a directory; `microslip` is the program.
fn shell(directory: &Path, command: &str) -> Output {
    let script = format!("microslip() {{ '{PROGRAM}' \"$@\"; }}\n{command}");
    Command::new("sh").args(["-c", &script]).current_dir(directory).output().unwrap()
}

/// Runs the program with arguments separated by blanks, and this standard input.
fn run(input: &[u8], arguments: &str) -> Output {
    let mut child = Command::new(PROGRAM)
        .args(arguments.split_whitespace())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The program does not read its input if the command line is invalid.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

/// Standard output of a run without errors and warnings.
fn stdout_with(input: &str, arguments: &str) -> String {
    let output = run(input.as_bytes(), arguments);
    assert!(output.status.success() && output.stderr.is_empty(), "{arguments}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn stdout(arguments: &str) -> String {
    stdout_with("", arguments)
}

/// Checks that a run fails with this exit status, a message that contains the text, and nothing on standard output.
fn assert_error(output: &Output, status: i32, text: &str) {
    let message = String::from_utf8_lossy(&output.stderr);
    let failed = output.status.code() == Some(status) && output.stdout.is_empty();
    assert!(failed && message.contains(text), "{text:?} expected: {output:?}");
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
    let bits =
        |rows: &[Vec<f64>]| rows.iter().map(|row| row.iter().map(|x| x.to_bits()).collect()).collect::<Vec<Vec<_>>>();
    assert_eq!(cells(table).0, header);
    assert!(bits(&numbers(table)) == bits(expected), "{table}\n{expected:?}");
}

#[test]
fn results_equal_those_of_the_library() {
    for (contact, options, [length, pressure, stiffness, energy]) in
        [(flat(), FLAT, ["m", "Pa", "N/m", "J"]), (ellipse(), ELLIPSE, ["mm", "MPa", "N/mm", "mJ"])]
    {
        let table = stdout(&format!("contact {options}"));
        let properties = [
            ("composite_modulus", contact.composite_modulus, pressure),
            ("half_width", contact.half_width, length),
            ("slip_force", contact.slip_force, "N"),
            ("slip_displacement", contact.slip_displacement, length),
            ("initial_stiffness", contact.initial_stiffness, stiffness),
            ("slip_energy", contact.slip_energy, energy),
        ];
        assert_eq!(cells(&table).0, "quantity,value,unit");
        assert_eq!(cells(&table).1.len(), properties.len() + 1);
        for (row, (name, value, unit)) in cells(&table).1.iter().zip(properties) {
            assert_eq!((row[0], row[1].parse(), row[2]), (name, Ok(value), unit));
        }

        let slip = contact.slip_displacement;
        let header = format!("displacement [{length}],force [N],stiffness [{stiffness}],stick_half_width [{length}]");
        let on_curve = |displacement: f64| {
            let point = contact.curve_at_displacement(displacement).unwrap();
            vec![displacement, point.force(), point.stiffness(), point.stick_half_width()]
        };
        let at_force = |force: f64| {
            let point = contact.curve_at_force(force).unwrap();
            vec![point.displacement(), force, point.stiffness(), point.stick_half_width()]
        };
        let table = stdout(&format!("curve {options} --points 11"));
        let grid = column(&table, 0);
        assert_eq!((grid.len(), grid[0], grid[10]), (11, 0.0, 1.25 * slip));
        assert_table(&table, &header, &grid.into_iter().map(on_curve).collect::<Vec<_>>());
        for (values, expected) in [
            ("--displacement -1e-7,1d-7,1", [-1e-7, 1e-7, 1.0].map(on_curve)),
            ("--displacement 0.3,-2,0 --relative", [0.3 * slip, -2.0 * slip, 0.0].map(on_curve)),
            ("--force -7,20,0", [-7.0, 20.0, 0.0].map(at_force)),
        ] {
            assert_table(&stdout(&format!("curve {options} {values}")), &header, &expected);
        }

        let header = format!("amplitude [{length}],displacement [{length}],force [N],dissipated [{energy}]");
        let expected = [0.5, 1.0, 1.5].map(|part| {
            let (amplitude, n) = (part * slip, 8);
            let hysteresis = contact.hysteresis_loop(amplitude).unwrap();
            let dissipated = contact.complex_stiffness(amplitude).unwrap().dissipated();
            (0..=n)
                .map(|i| vec![amplitude, hysteresis.displacement(i, n), hysteresis.force(i, n), dissipated])
                .collect::<Vec<_>>()
        });
        assert_table(&stdout(&format!("loop {options} --points 8")), &header, &expected.concat());
        assert_table(&stdout(&format!("loop {options} --points 8 --amplitude 1 --relative")), &header, &expected[1]);

        let header = format!(
            "amplitude [{length}],k_real [{stiffness}],k_imag [{stiffness}],dk_real [{stiffness}^2],dk_imag [{stiffness}^2],\
             dissipated [{energy}]"
        );
        let complex = |amplitude: f64| {
            let k = contact.complex_stiffness(amplitude).unwrap();
            vec![amplitude, k.real(), k.imaginary(), k.d_real(), k.d_imag(), k.dissipated()]
        };
        let jenkins_header = format!("amplitude [{length}],stiffness [{stiffness}],slip_force [N]");
        let slider = |amplitude: f64| {
            let slider = jenkins(&contact, amplitude).unwrap();
            vec![amplitude, slider.stiffness, slider.slip_force]
        };
        for (grid_options, ends) in [
            ("", [0.01 * slip, 100.0 * slip]),
            ("--from 1e-8 --to 3e-5", [1e-8, 3e-5]),
            ("--from 1e-300 --to 1e150", [1e-300, 1e150]),
        ] {
            let table = stdout(&format!("stiffness {options} {grid_options} --points 9"));
            let grid = column(&table, 0);
            assert_eq!((grid.len(), grid[0], grid[8]), (9, ends[0], ends[1]));
            let middle = (0.5 * (ends[0].ln() + ends[1].ln())).exp();
            // Logarithms of up to 700, each rounded.
            assert!((grid[4] / middle - 1.0).abs() < 1e-12, "{grid:?}");
            assert_table(&table, &header, &grid.iter().copied().map(complex).collect::<Vec<_>>());
            let table = stdout(&format!("jenkins {options} {grid_options} --points 9"));
            assert_table(&table, &jenkins_header, &grid.into_iter().map(slider).collect::<Vec<_>>());
        }
        let amplitudes = [0.0, 1e-7, 2e-3];
        assert_table(
            &stdout(&format!("stiffness {options} --amplitude 0,1e-7,2e-3")),
            &header,
            &amplitudes.map(complex),
        );
        assert_table(
            &stdout(&format!("jenkins {options} --amplitude 0,1e-7,2e-3")),
            &jenkins_header,
            &amplitudes.map(slider),
        );

        let mut expected = Vec::new();
        let error = iwan(&contact, 7, |slider| {
            expected.push(vec![expected.len() as f64 + 1.0, slider.stiffness, slider.slip_force])
        });
        let table = stdout(&format!("iwan {options} --count 7"));
        assert_table(&table, &format!("slider [-],stiffness [{stiffness}],slip_force [N]"), &expected);
        let remark = table.lines().find_map(|line| line.strip_prefix("# largest error of the force over mu N: "));
        assert_eq!(remark.map(str::parse), Some(Ok(error.unwrap())));
    }
}

#[test]
fn tractions_equal_those_of_the_library() {
    let contact = flat();
    let row = |(force, x)| {
        let point = contact.curve_at_force(force).unwrap();
        vec![force, x, contact.pressure(x), point.shear(x), point.slip(x).unwrap(), point.damage(x).unwrap()]
    };
    let points = [-10.0, 55.5].into_iter().flat_map(|force| [-1e-5, 0.0, 5e-5, 1.2e-4, 1e-3].map(|x| (force, x)));
    let table = stdout(&format!("tractions {FLAT} --force -10,55.5 --position -1e-5,0,5e-5,1.2e-4,1e-3"));
    let header = "force [N],x [m],pressure [Pa],shear [Pa],slip [m],damage [N/m]";
    assert_table(&table, header, &points.map(row).collect::<Vec<_>>());

    let contact = ellipse();
    let table = stdout(&format!("tractions {ELLIPSE} --force 0.25 --relative --points 5"));
    let (force, x) = (0.25 * contact.slip_force, column(&table, 1));
    let point = contact.curve_at_force(force).unwrap();
    assert_eq!((x.len(), x[0], x[4]), (5, -contact.half_width, contact.half_width));
    let rows: Vec<_> = x.iter().map(|&x| vec![force, x, contact.pressure(x), point.shear(x)]).collect();
    assert_table(&table, "force [N],x [mm],pressure [MPa],shear [MPa]", &rows);
}

#[test]
fn the_maximum_pressure_is_that_of_a_fine_grid() {
    let maximum = |options: &str| cells(&stdout(&format!("contact {options}"))).1[6][1].parse::<f64>().unwrap();
    // 3N/(2π b l), up to the rounding of the products.
    let of_ellipse = 3.0 * 400.0 / (2.0 * std::f64::consts::PI * 0.2 * 0.6);
    assert!((maximum(ELLIPSE) / of_ellipse - 1.0).abs() < 1e-15);
    for flat in ["0", "1e-9", "5e-5", "1e-3"] {
        let options = FLAT.replace("width 5e-5", &format!("width {flat}"));
        let table = stdout(&format!("tractions {options} --points 20001"));
        let largest = column(&table, 2).into_iter().fold(0.0, f64::max);
        // The grid misses the maximum by at most 1/20000 of the width; the slope is zero there.
        let maximum = maximum(&options);
        assert!(maximum >= largest * (1.0 - 1e-15) && maximum < largest * (1.0 + 1e-5), "{flat}: {maximum} {largest}");
    }
}

#[test]
fn histories_equal_those_of_the_library() {
    let contact = flat();
    // A history with gross slip, and a spiral of 3000 nested reversals which the last step closes.
    let spiral = (0..3000).map(|i| 2.9e-7 * if i % 2 == 0 { 1.0 } else { -1.0 } * (1.0 - f64::from(i) / 3001.0));
    let paths =
        [vec![5e-7, -3e-7, 2e-7, -1e-7, 8e-7, 3e-6, 2.5e-6, 2.5e-6], spiral.chain([2.93e-7]).collect::<Vec<_>>()];
    let header = "displacement [m],force [N],stiffness [N/m],dissipated [J]";
    for path in paths {
        let n = path.len();
        let mut state = vec![0.0; state_length(n)];
        let [mut force, mut stiffness, mut dissipated] = [(); 3].map(|()| vec![0.0; n]);
        state_init(&mut state).unwrap();
        let output =
            PathOutput { force: Some(&mut force), stiffness: Some(&mut stiffness), dissipated: Some(&mut dissipated) };
        masing::path(&contact, &mut state, &path, output);
        let expected: Vec<_> = (0..n).map(|i| vec![path[i], force[i], stiffness[i], dissipated[i]]).collect();
        let input = path.iter().map(|displacement| format!("{displacement:e}\n")).collect::<String>();
        let table = stdout_with(&input, &format!("history {FLAT}"));
        assert_table(&table, header, &expected);
        // A table of results is a valid input.
        assert_table(&stdout_with(&table, &format!("history {FLAT}")), header, &expected);
        assert_table(&stdout_with(&table, &format!("history {FLAT} --column 1 --displacements -")), header, &expected);
        // Nothing is left of the nested reversals.
        let last = contact.curve_at_displacement(path[n - 1]).unwrap();
        assert!(n < 10 || (last.force() == force[n - 1] && last.stiffness() == stiffness[n - 1]));
    }
    let relative = stdout_with("u\n0.5\n-0.25\n", &format!("history {FLAT} --relative"));
    assert_eq!(column(&relative, 0), [0.5, -0.25].map(|part| part * contact.slip_displacement));
}

#[test]
fn the_command_in_a_result_repeats_it() {
    let directory = directory("repeat");
    fs::write(directory.join("path's.csv"), "0.5\n-1\n2").unwrap();
    for (example, options) in [("example", ""), ("example --elliptic", ELLIPSE)] {
        fs::write(directory.join("contact.toml"), stdout(example)).unwrap();
        let commands = [
            "contact contact.toml",
            "tractions contact.toml",
            "tractions contact.toml --position 0,1e-4",
            "curve contact.toml --normal-force 12.5 --poisson-ratio 0.25,0.3",
            "curve contact.toml --force 3",
            "curve contact.toml --displacement -1 --relative",
            "loop contact.toml",
            "stiffness contact.toml",
            "stiffness contact.toml --amplitude \"1e-6, 2e-6\"",
            "jenkins contact.toml",
            "iwan contact.toml",
            "history contact.toml --relative --displacements path\\'s.csv",
            "curve contact.toml --displacement-reference rigid_strip",
        ];
        for command in &commands[..commands.len() - usize::from(!options.is_empty())] {
            let result = shell(&directory, &format!("microslip {command}"));
            let table = String::from_utf8(result.stdout).unwrap();
            let repeat = table.lines().nth(1).unwrap().strip_prefix("# ").unwrap();
            let again = shell(&directory, repeat);
            assert!(result.status.success() && again.status.success(), "{command}: {repeat}: {again:?}");
            assert_eq!(String::from_utf8(again.stdout).unwrap(), table, "{repeat}");
        }
        let table = shell(&directory, "microslip curve contact.toml").stdout;
        assert!(options.is_empty() || String::from_utf8(table).unwrap() == stdout(&format!("curve {options}")));
    }
}

#[test]
fn options_override_the_parameter_file() {
    let file = "flat_half_width = 5e-5\nedge_radius = 0.005\nlength = 0.01\nnormal_force = 150\nfriction_coefficient = 0.4\n\
                [[material]]\nyoung_modulus = 2e11\npoisson_ratio = 0.3\n\
                [[material]]\nyoung_modulus = 114e9\npoisson_ratio = 0.32\n";
    let expected = stdout(&format!("curve {FLAT}"));
    assert_eq!(stdout_with(file, "curve -"), expected);
    let other = file.replace("= 150", "= 7").replace("= 0.4", "= 0.1").replace("poisson_ratio = 0.32\n", "");
    let options = "--normal-force 150 --friction-coefficient 0.4 --poisson-ratio 0.3,0.32";
    assert_eq!(stdout_with(&other, &format!("curve - {options}")), expected);
    // One table stands for both bodies.
    let one = file.split_at(file.rfind("[[material]]").unwrap()).0;
    let both = FLAT.replace("2e11,114e9", "2e11").replace("0.3,0.32", "0.3");
    assert_eq!(stdout_with(one, "curve -"), stdout(&format!("curve {both}")));
}

/// The options of the flat with one of them changed; without it for an empty value.
fn with(option: &str, value: &str) -> String {
    let (before, rest) = FLAT.split_once(option).unwrap();
    let after = rest.trim_start().split_once(' ').map_or("", |(_, after)| after);
    if value.is_empty() { format!("{before} {after}") } else { format!("{before} {option} {value} {after}") }
}

#[test]
fn messages_name_the_error_and_what_is_allowed() {
    // Messages of the library.
    for (arguments, before, error, after) in [
        (format!("curve {}", with("--edge-radius", "0")), "microslip: ", Error::BadEdgeRadius, ", not 0\n"),
        (format!("curve {}", with("--normal-force", "-1e-3")), "microslip: ", Error::BadNormalForce, ", not -1e-3\n"),
        (
            format!("curve {}", with("--young-modulus", "2e11,nan")),
            "microslip: ",
            Error::BadYoungModulus,
            ", not 2e11,NaN\n",
        ),
        (format!("curve {}", with("--poisson-ratio", "0.6")), "microslip: ", Error::BadPoissonRatio, ", not 0.6\n"),
        (format!("curve {}", with("--normal-force", "1e300")), "microslip: ", Error::OutOfRange, "\n"),
        (format!("tractions {FLAT} --force 61"), "--force 61: ", Error::ForceExceedsSlip, ", which is 60 N\n"),
        (format!("curve {FLAT} --force inf"), "--force inf: ", Error::BadForce, "\n"),
        (format!("curve {FLAT} --displacement 1e151"), "--displacement 1e151: ", Error::BadDisplacement, "\n"),
        (format!("curve {FLAT} --to nan"), "--to NaN: ", Error::BadDisplacement, "\n"),
        (format!("loop {FLAT} --amplitude 1e-6,-1"), "--amplitude -1: ", Error::BadAmplitude, "\n"),
        (format!("stiffness {FLAT} --amplitude nan"), "--amplitude NaN: ", Error::BadAmplitude, "\n"),
        (format!("jenkins {FLAT} --from 1 --to 1e200"), "--to 1e200: ", Error::BadAmplitude, "\n"),
        (format!("iwan {FLAT} --count 0"), "--count 0: ", Error::BadCount, "\n"),
        (format!("tractions {FLAT} --position inf"), "--position inf: ", Error::BadPosition, "\n"),
    ] {
        assert_error(&run(b"", &arguments), 1, &format!("{before}{error}{after}"));
    }
    for (status, arguments, text) in [
        (1, format!("stiffness {}", with("--normal-force", "0")), "give --from and --to, or --amplitude"),
        (1, format!("curve {FLAT} --semi-axis-x 1"), "parameters of two shapes"),
        (1, format!("curve {ELLIPSE} --displacement-reference rigid_strip"), "parameters of two shapes"),
        (1, "contact no-such-file.toml".to_owned(), "no-such-file.toml: No such file"),
        (1, format!("history {FLAT} --displacements /"), "/: Is a directory"),
        (2, String::new(), "Usage: microslip <COMMAND>"),
        (
            2,
            format!("curve {}", with("--length", "")),
            "missing parameters: length; give them in a parameter file or by --length",
        ),
        (
            2,
            "contact".to_owned(),
            "--flat-half-width, --edge-radius, --length, --normal-force, --friction-coefficient, --young",
        ),
        (2, "contact --semi-axis-x 1".to_owned(), "missing parameters: semi_axis_y, normal_force,"),
        (2, format!("curve {FLAT} --poison-ratio 0.3"), "a similar argument exists: '--poisson-ratio'"),
        (2, format!("curve {FLAT} --points 1"), "1 is not in 2..="),
        (2, format!("curve {}", with("--young-modulus", "1,2,3")), "a contact has two bodies"),
        (2, format!("curve {FLAT} --force 1 --displacement 1"), "cannot be used with"),
        (2, format!("stiffness {FLAT} --from 2 --to 1"), "0 < --from <= --to is required, not 2 and 1"),
        (2, format!("curve {FLAT} --plot picture.pdf"), "--plot picture.pdf: the extension must be .svg or .png"),
        (2, format!("curve {}", with("--length", "1O")), "invalid value '1O' for '--length <m>': not a number"),
        (2, format!("curve {}", with("--length", "0,01")), "the decimal separator is a point"),
        (2, format!("loop {FLAT} --amplitude 5e-7, 1e-6"), "lists are written without blanks, or in quotes"),
        (2, "history - --displacements -".to_owned(), "standard input cannot be both"),
    ] {
        assert_error(&run(b"", &arguments), status, text);
    }
}

#[test]
fn a_length_that_is_too_short_is_reported_with_its_limit() {
    for reference in ["centre_point", "rigid_strip"] {
        let contact = |length: &str| {
            run(b"", &format!("contact {} --displacement-reference {reference}", with("--length", length)))
        };
        let output = contact("1e-6");
        assert_error(&output, 1, &format!("{}; length = 1e-6 m, b = ", Error::LengthTooShort));
        let message = String::from_utf8(output.stderr).unwrap();
        let limit: f64 = message.split("must exceed ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!(
            contact(&format!("{limit}")).status.success() && !contact(&format!("{}", 0.998 * limit)).status.success()
        );
    }
}

#[test]
fn dimensions_outside_the_model_are_reported_as_warnings() {
    let cases = [
        ("--edge-radius", "1e-5", "exceeds the radius R = 10.0 µm"),
        ("--length", "2e-4", "is below 2"),
        ("--length", "0.1", ""),
    ];
    for (option, value, text) in cases {
        let output = run(b"", &format!("contact {}", with(option, value)));
        let warning = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && !output.stdout.is_empty());
        assert!(
            warning.contains(text) && warning.lines().count() == usize::from(!text.is_empty()),
            "{value}: {warning}"
        );
    }
}

#[test]
fn errors_in_files_name_file_and_line() {
    let directory = directory("errors");
    let example = stdout("example");
    let run_with = |parameters: &[u8], table: &[u8], command: &str| {
        fs::write(directory.join("contact.toml"), parameters).unwrap();
        fs::write(directory.join("table.csv"), table).unwrap();
        shell(&directory, &format!("microslip {command}"))
    };
    for (from, to, text) in [
        ("edge_radius", "edge_radious", "line 4, column 1\n"),
        (
            "edge_radius",
            "edge_radious",
            "unknown field `edge_radious`, expected one of `flat_half_width`, `edge_radius`, ",
        ),
        ("poisson_ratio", "length", "unknown field `length`, expected `young_modulus` or `poisson_ratio`"),
        ("units = \"si\"", "young_modulus = 1", "unknown field `young_modulus`"),
        ("\"si\"", "\"inch\"", "unknown variant `inch`, expected `si` or `mm`"),
        ("0.1e-3", "-1", &format!("{}, not -1", Error::BadFlatHalfWidth)),
        ("50e-3", "nan", &format!("{}, not NaN", Error::BadEdgeRadius)),
        ("800", "'800'", "invalid type: string \"800\", expected f64"),
        ("20e-3", "20e", "line 5"),
        ("[[material]]", "[[material]]\n[[material]]\n[[material]]", "at most two tables [[material]]"),
    ] {
        assert!(example.contains(from));
        let output = run_with(example.replace(from, to).as_bytes(), b"", "contact contact.toml");
        assert_error(&output, 1, text);
        assert_error(&output, 1, "microslip: contact.toml: ");
    }
    assert_error(
        &run_with(example.as_bytes(), b"", "contact contact.toml --units mm"),
        1,
        "--units differs from the units",
    );
    assert_error(&run_with(b"# \xb5 = 0.5", b"", "contact contact.toml"), 1, "contact.toml: line 1: invalid UTF-8");
    for (table, text) in [
        (&b"1e-6\n1e-6m"[..], "table.csv: line 2: \"1e-6m\": not a number"),
        (b"# c\nu\n1e-6\ninf", &format!("table.csv: line 4: {}", Error::BadDisplacement)),
        (b"u\n0\n0,5e-6\n", "table.csv: line 3: 2 columns, but the first row has 1; is a comma the decimal separator?"),
        (b"t;u\n0;1\n", "table.csv: line 1: columns are separated by commas, not by semicolons"),
        (b"u\n1\n2 # \xb5m\n", "table.csv: line 3: invalid UTF-8"),
    ] {
        assert_error(&run_with(example.as_bytes(), table, "history contact.toml --displacements table.csv"), 1, text);
    }
    assert_error(
        &run(b"1\nx", &format!("history {FLAT}")),
        1,
        "microslip: standard input: line 2: \"x\": not a number",
    );
}

/// Checks that a picture is complete, and an SVG's lines inside of it.
fn assert_picture(path: &Path) {
    let bytes = fs::read(path).unwrap();
    assert!(bytes.len() < 1_000_000, "{}", bytes.len());
    if path.extension().unwrap() == "png" {
        let size = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        assert!(bytes.starts_with(b"\x89PNG") && size(16) == 1720 && size(20) >= 872 && bytes.len() > 10_000);
        return;
    }
    let text = String::from_utf8(bytes).unwrap();
    let height: f64 = text.split("height=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
    assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n") && text.matches("<path").count() > 10);
    for path in text.split(" d=\"").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        for point in path.split(['M', 'L']).skip(1) {
            let (x, y) = point.split_once(' ').unwrap();
            let inside = |value: &str, end: f64| (0.0..=end).contains(&value.parse().unwrap());
            assert!(inside(x, 860.0) && inside(y, height), "{point}: {text}");
        }
    }
}

#[test]
fn every_command_draws() {
    let directory = directory("pictures");
    let picture = |name: &str| directory.join(name);
    for options in [FLAT, ELLIPSE, &with("--normal-force", "0")] {
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
            let _ = fs::remove_file(picture("picture.svg"));
            stdout(&format!("{command} {options} --plot {}", picture("picture.svg").display()));
            assert_picture(&picture("picture.svg"));
        }
    }
    // Between two rows a history follows the branch. A long one is thinned.
    let spiral = (0..100_000).map(|i| format!("{}\n", 2.9e-7 * f64::from(i % 2 * 2 - 1) * (1.0 - 1e-5 * f64::from(i))));
    for (name, table) in
        [("two.svg", "1e-6\n-1e-6\n"), ("one.png", "1e-6\n"), ("spiral.svg", &spiral.collect::<String>())]
    {
        stdout_with(table, &format!("history {FLAT} --plot {}", picture(name).display()));
        assert_picture(&picture(name));
    }
    let svg = fs::read_to_string(picture("two.svg")).unwrap();
    assert!(svg.split(" d=\"").any(|rest| rest.split('"').next().unwrap().matches('L').count() > 100));

    stdout(&format!("loop {FLAT} --amplitude 1e-6,2e-6 --plot {}", picture("loop.svg").display()));
    let svg = fs::read_to_string(picture("loop.svg")).unwrap();
    for text in
        ["displacement [µm]", "force [N]", "±1.00 µm, ", "a = 50.0 µm, R = 5.00 mm, L = 10.0 mm, N = 150 N, μ = 0.4"]
    {
        assert!(svg.contains(text), "{text}: {svg}");
    }
}

#[test]
fn outputs_are_complete_and_inputs_are_not_overwritten() {
    let directory = directory("outputs");
    let sh = |command: &str| shell(&directory, command);
    let (curve, contact) = (stdout(&format!("curve {FLAT}")), stdout(&format!("contact {FLAT}")));
    let read = |name: &str| fs::read_to_string(directory.join(name)).unwrap();
    let written = sh(&format!("microslip curve {FLAT} --out table.csv --plot picture.svg"));
    assert!(written.status.success() && written.stdout.is_empty());
    assert_eq!(read("table.csv"), curve);
    assert_eq!(sh(&format!("microslip curve {FLAT} --out -")).stdout, curve.as_bytes());
    // After an error in the input the old file stays.
    assert_error(&sh(&format!("microslip tractions {FLAT} --force 61 --out table.csv")), 1, "--force 61: ");
    assert_eq!(read("table.csv"), curve);

    fs::write(directory.join("contact.toml"), stdout("example")).unwrap();
    for (status, command, text) in [
        (2, "curve contact.toml --out ./contact.toml".to_owned(), "contact.toml is an input and is not overwritten"),
        (2, format!("history {FLAT} --displacements table.csv --out table.csv"), "is an input and is not overwritten"),
        (2, format!("curve {FLAT} --out picture.svg --plot picture.svg"), "cannot be both the table and the picture"),
        (1, format!("curve {FLAT} --out no/such/place.csv"), "no/such/place.csv: No such file"),
        (1, format!("curve {FLAT} --out ."), ".: Is a directory"),
        (1, format!("contact {FLAT} >&-"), "standard output: it is closed"),
    ] {
        assert_error(&sh(&format!("microslip {command}")), status, text);
    }
    // A reader may close its end of the pipe.
    let pipe = sh(&format!("{{ microslip curve {FLAT} --points 100000; echo $? >&2; }} | true"));
    assert_eq!(pipe.stderr, b"0\n");
    if cfg!(target_os = "linux") {
        assert_error(&sh(&format!("microslip contact {FLAT} > /dev/full")), 1, "standard output: No space left");
        let pipe = sh(&format!(
            "mkfifo pipe && {{ timeout 10 cat pipe & microslip contact {FLAT} --out pipe; wait; test -p pipe; }}"
        ));
        assert!(pipe.status.success() && pipe.stdout == contact.as_bytes(), "{pipe:?}");
        fs::remove_file(directory.join("pipe")).unwrap();
        // Links are followed; an existing file keeps its permissions, and a new one has those of the umask.
        sh("echo old > private.csv; chmod 600 private.csv; ln -s private.csv link.csv");
        let modes = sh(&format!(
            "umask 027; microslip contact {FLAT} --out link.csv && microslip contact {FLAT} --out new.csv; \
             stat -c '%a %F' link.csv private.csv new.csv"
        ));
        assert_eq!(modes.stdout, b"777 symbolic link\n600 regular file\n640 regular file\n");
        assert_eq!((read("private.csv"), read("new.csv")), (contact.clone(), contact));
        // A full disk is reported; a signal while writing leaves no other file.
        let full = sh(&format!("trap '' XFSZ; ulimit -f 1; microslip loop {FLAT} --out full.csv"));
        assert_error(&full, 1, "full.csv: File too large (os error 27); the file is incomplete");
        assert!(!sh(&format!("ulimit -f 1; exec '{PROGRAM}' loop {FLAT} --out full.csv")).status.success());
        let files = "contact.toml\nfull.csv\nlink.csv\nnew.csv\npicture.svg\nprivate.csv\ntable.csv\n";
        assert_eq!(String::from_utf8(sh("ls -A").stdout).unwrap(), files);
    }
    assert_eq!(read("contact.toml"), stdout("example"));
}

#[test]
fn help_has_units_and_an_example_for_each_command() {
    let general = stdout("--help");
    for text in ["m, N, Pa, N/m, J", "mm, N, MPa, N/mm, mJ", "Exit status:", "microslip example > contact.toml"] {
        assert!(general.contains(text), "{text}");
    }
    let directory = directory("help");
    fs::write(directory.join("contact.toml"), stdout("example")).unwrap();
    fs::write(directory.join("measured.csv"), "t,u\n0,1e-6\n1,-1e-6\n").unwrap();
    for command in ["contact", "tractions", "curve", "loop", "stiffness", "history", "jenkins", "iwan"] {
        assert!(general.contains(&format!("\n  {command} ")), "{command}");
        let help = stdout(&format!("{command} --help"));
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
        // The example works, and the columns are those of its table.
        let (before, example) = help.split_once("Example:\n  ").unwrap();
        let columns = before.split_once("Columns:\n  ").unwrap().1;
        let output = shell(&directory, &format!("{} --out -", example.trim_end().replace(" --out curve.csv", "")));
        let table = String::from_utf8(output.stdout);
        assert!(output.status.success(), "{example}: {:?}", output.stderr);
        for name in cells(&table.unwrap()).0.split(',').map(|name| name.split(' ').next().unwrap()) {
            assert!(columns.contains(name), "{command}: {name}");
        }
    }
    assert_eq!(stdout("--version"), format!("microslip {}\n", env!("CARGO_PKG_VERSION")));
}
