//! The program as its users call it, from a shell: results, messages, pictures and files. `expected` has commands with their
//! tables, `cases` commands and tables with the messages that they get.

use microslip::Error;
use serde::de::DeserializeOwned;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_microslip");

/// The contacts of `inputs` as options; `$FLAT`, a flat between different bodies, and `$ELLIPSE` in the shell.
const FLAT: &str = "--displacement-reference centre_point --flat-half-width 5e-5 --edge-radius 5e-3 --length 1e-2 \
                    --normal-force 150 --friction-coefficient 0.4 \
                    --young-modulus 2e11,114e9 --poisson-ratio 0.3,0.32";
const ELLIPSE: &str = "--semi-axis-x 0.2 --semi-axis-y 0.6 --normal-force 400 --friction-coefficient 0.5 --young-modulus 200e3 \
                       --poisson-ratio 0.3 --units mm";
/// Of the flat.
const HALF_WIDTH: f64 = 7.442173066591084e-5;
const INITIAL_STIFFNESS: f64 = 209021141.3612922;

/// A folder or file beside this one.
fn beside(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

/// The rows of a file of `cases`.
fn cases<T: DeserializeOwned>(name: &str) -> Vec<T> {
    serde_json::from_str(&fs::read_to_string(beside(&format!("cases/{name}.json"))).unwrap()).unwrap()
}

/// A shell in a directory of its own, with the files of `inputs`.
struct Shell(PathBuf);

impl Shell {
    fn new(name: &str) -> Shell {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(&directory).unwrap();
        for input in fs::read_dir(beside("inputs")).unwrap().map(|entry| entry.unwrap().path()) {
            fs::copy(&input, directory.join(input.file_name().unwrap())).unwrap();
        }
        Shell(directory)
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

    /// Checks the refusals of commands: exit status, command and a part of the message.
    fn check_refusals(&self, is_checked: impl Fn(&str) -> bool) {
        for (status, command, text) in cases::<(i32, String, String)>("refusals") {
            if is_checked(&command) {
                self.check_error(&format!("microslip {command}"), status, &text);
            }
        }
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

/// Whether two texts are equal but for the last digits of numbers, which differ between processors.
fn is_same(found: &str, expected: &str) -> bool {
    let [found, expected] = [found, expected].map(|text| text.split([',', '\n']).collect::<Vec<_>>());
    let is_near = |one: &str, other: &str| match (one.parse::<f64>(), other.parse::<f64>()) {
        (Ok(one), Ok(other)) => (one - other).abs() <= 1e-11 * other.abs(),
        _ => one == other,
    };
    found.len() == expected.len() && found.into_iter().zip(expected).all(|(one, other)| is_near(one, other))
}

/// The files of `expected`: commands, and the table that each of them gives. With `MICROSLIP_WRITE` set, tables that differ are
/// written.
#[test]
fn results_are_those_expected() {
    let shell = Shell::new("results");
    let mut number = 0;
    for path in fs::read_dir(beside("expected")).unwrap().map(|entry| entry.unwrap().path()) {
        let file = fs::read_to_string(&path).unwrap();
        let commands = file.lines().map_while(|line| line.strip_prefix("# microslip "));
        let lines: Vec<&str> = file.split_inclusive('\n').collect();
        let (head, expected) = lines.split_at(commands.clone().count());
        let expected = expected.concat();
        for command in commands {
            number += 1;
            let table = shell.stdout(&format!("microslip {command}"));
            let found: String = table.split_inclusive('\n').skip(2).collect();
            let is_right = is_same(&found, &expected);
            if !is_right && std::env::var_os("MICROSLIP_WRITE").is_some() {
                fs::write(&path, head.concat() + &found).unwrap();
                continue;
            }
            assert!(is_right, "{command}:\n{found}instead of\n{expected}");
            if !command.contains(['<', '|']) {
                shell.check_repeated(&table);
            }
        }
    }
    assert!(number > 60, "{number}");
}

/// 3000 nested reversals, all of which the last step closes.
#[test]
fn no_reversals_of_a_history_are_merged() {
    let shell = Shell::new("histories");
    let spiral = (0..3000).map(|i| 2.9e-7 * f64::from(i % 2 * 2 - 1) * (1.0 - f64::from(i) / 3001.0)).chain([2.93e-7]);
    shell.write("spiral.csv", spiral.map(|displacement| format!("{displacement:e}\n")).collect::<String>());
    let rows = numbers(&shell.stdout("microslip history flat.toml --displacements spiral.csv"));
    let curve = numbers(&shell.stdout("microslip curve flat.toml --displacement 2.93e-7"));
    assert_eq!((rows.len(), &rows[3000][..3]), (3001, &curve[0][..3]));
}

/// The displacements 1e-6 and -2e-6 as programs write them; if they are in another unit, the table states it.
#[test]
fn tables_of_other_programs_are_read() {
    let shell = Shell::new("tables");
    for (options, table) in cases::<(String, String)>("tables") {
        shell.write("table.csv", &table);
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
    let shape = 5e-5 / HALF_WIDTH;
    for (name, expected) in [
        ("friction_coefficient", 0.4),
        ("contact_compliance", 1.0),
        ("total_compliance", 1.0 / INITIAL_STIFFNESS),
        ("flat_half_width_over_half_width", shape),
    ] {
        let (value, status) = quantity(&table, name);
        // The loops have a reversal at a sample, and no noise.
        assert!((value / expected - 1.0).abs() < 1e-3 && status == "determined", "{name}: {value} {expected} {status}");
    }
    assert!(table.contains("# The shape is determined"), "{table}");
    // The fitted contact is a parameter file.
    assert!(shell.stdout("microslip contact new.toml").contains("initial_stiffness"));
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
    shell.check_refusals(|command| command.starts_with("fit"));

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
}

#[test]
fn the_command_in_a_result_repeats_it() {
    let shell = Shell::new("repeat");
    shell.write("path's.csv", "0.5\n-1\n2");
    for example in ["example", "example --elliptic"] {
        shell.write("contact.toml", shell.stdout(&format!("microslip {example}")));
        for command in [
            "curve contact.toml --normal-force 12.5 --poisson-ratio 0.25,0.3",
            "curve flat.toml --displacement-reference rigid_strip",
            "loop contact.toml",
            "stiffness contact.toml",
            "jenkins contact.toml",
            "iwan contact.toml",
            "history contact.toml --relative --displacements path\\'s.csv --column 1",
            "history contact.toml --displacements two.csv --column u --column-y v --approach-column N --relative",
        ] {
            shell.check_repeated(&shell.stdout(&format!("microslip {command}")));
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
    let flat = shell.read("flat.toml");
    let other = flat.replace("= 150", "= 7").replace("= 0.4", "= 0.1").replace("poisson_ratio = 0.32\n", "");
    shell.write("other.toml", other);
    let options = "--normal-force 150 --friction-coefficient 0.4 --poisson-ratio 0.3,0.32";
    assert_eq!(result(&shell.stdout(&format!("microslip curve other.toml {options}"))), result(&expected));
    // One table stands for both bodies.
    shell.write("one.toml", flat.split_at(flat.rfind("[[material]]").unwrap()).0);
    let both = shell.stdout("microslip curve flat.toml --young-modulus 2e11 --poisson-ratio 0.3");
    assert_eq!(result(&shell.stdout("microslip curve one.toml")), result(&both));
}

#[test]
fn messages_name_the_error_and_what_is_allowed() {
    let shell = Shell::new("messages");
    shell.check_refusals(|command| !command.starts_with("fit"));
    for (command, text, count) in cases::<(String, String, usize)>("warnings") {
        let output = shell.run(&format!("microslip {command}"));
        let warning = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && !output.stdout.is_empty());
        assert!(warning.contains(&text) && warning.lines().count() == count, "{command}: {warning}");
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
    let tables =
        cases::<(String, String, String)>("bad_tables").into_iter().map(|(o, t, text)| (o, t.into_bytes(), text));
    let no_text = (String::new(), b"\x89PNG\0\0".to_vec(), "this is no text".to_owned());
    for (options, table, text) in tables.chain([no_text]) {
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
    shell.stdout("rm *.csv ellipse.toml si.toml");
    let (curve, contact) = (shell.stdout("microslip curve flat.toml"), shell.stdout("microslip contact flat.toml"));
    let flat = shell.read("flat.toml");
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
    assert_eq!((shell.read("table.csv"), shell.read("flat.toml")), (curve, flat));
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
