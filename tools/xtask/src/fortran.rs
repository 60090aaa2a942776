//! The generated blocks of the Fortran module: constants, result types and the interfaces of the C functions, from the text of
//! the C header.
//!
//! In the module, a block stands between the lines `! <generated: NAME>` and `! </generated>`.

use crate::interface::{Declaration, Header, Prototype, functions};
use crate::wrappers;

/// Column at which comments and statements are wrapped; a line that takes a short comment along may have `LONGEST`.
const WIDTH: usize = 120;
/// The longest line of free-form Fortran.
const LONGEST: usize = 132;
/// A blank at which no line is broken.
pub const UNBROKEN: char = '\u{a0}';

/// Fills the generated blocks of the module from the header.
pub fn fill(module: &str, header: &str) -> Result<String, String> {
    let declared = Header::new(header)?;
    let prototypes = declared.prototypes()?;
    let mut blocks =
        vec![("constants", constants(header)), ("types", types(header)?), ("functions", interfaces(&prototypes)?)];
    blocks.extend(wrappers::blocks(&functions(&prototypes)?));
    replaced(module, blocks)
}

/// Replaces each block between a line `<generated: NAME>` and a line `</generated>`, both comments.
fn replaced(module: &str, mut blocks: Vec<(&'static str, Vec<String>)>) -> Result<String, String> {
    let mut filled = Vec::new();
    let mut lines = module.lines();
    while let Some(line) = lines.next() {
        filled.push(line.to_owned());
        let marker = line.trim_start_matches([' ', '!', '#']);
        let Some(name) = marker.strip_prefix("<generated: ").and_then(|rest| rest.strip_suffix('>')) else { continue };
        let place =
            blocks.iter().position(|block| block.0 == name).ok_or(format!("no such generated block: {name}"))?;
        filled.extend(blocks.swap_remove(place).1);
        let end = lines.find(|line| line.trim_start_matches([' ', '!', '#']) == "</generated>");
        filled.push(end.ok_or(format!("the generated block does not end: {name}"))?.to_owned());
    }
    if let Some((name, _)) = blocks.first() {
        return Err(format!("the generated block is missing: {name}"));
    }
    match filled.iter().find(|line| line.chars().count() > LONGEST) {
        Some(line) => Err(format!("longer than {LONGEST} columns: {line}")),
        None => Ok(filled.join("\n") + "\n"),
    }
}

/// The status codes and the rows of a sensitivity, as members of the enumerations in Python.
pub fn python(source: &str, header: &str) -> Result<String, String> {
    let statuses = microslip::Error::ALL
        .iter()
        .map(|error| format!("    {} = {}", &error.constant()["MSLIP_".len()..], error.code()));
    let parameters = header.lines().filter_map(|line| line.strip_prefix("#define MSLIP_BY_")?.split_once(' '));
    let parameters = parameters.map(|(name, value)| format!("    {name} = {value}"));
    replaced(source, vec![("statuses", statuses.collect()), ("parameters", parameters.collect())])
}

/// The integer constants but for the version of the package, which `mslip_version` returns.
fn constants(header: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for (item, comment) in items(header) {
        let mut words = item.split_ascii_whitespace();
        let (Some("#define"), Some(name), Some(value)) = (words.next(), words.next(), words.next()) else { continue };
        if name.starts_with("MSLIP_VERSION_") || value.parse::<i32>().is_err() {
            continue;
        }
        // Indices of arrays are counted from 1.
        let from_1 = value.parse::<i32>().map(|index| (index + 1).to_string());
        let value = if name.starts_with("MSLIP_BY_") { from_1.as_deref().unwrap_or(value) } else { value };
        // Fortran ignores case: `mslip_abi_version` is a function.
        let name = if name == "MSLIP_ABI_VERSION" { "MSLIP_MODULE_ABI_VERSION" } else { name };
        lines.extend(commented("  ", format!("integer(mslip_int), parameter, public :: {name} = {value}"), &comment));
    }
    lines
}

/// The types that the library fills: the structures with a reserved array. Every component is 0 until then.
fn types(header: &str) -> Result<Vec<String>, String> {
    let mut lines = Vec::new();
    let mut components = None;
    for (item, comment) in items(header) {
        let item = item.trim_end_matches(';');
        if let Some(name) = item.strip_prefix("typedef struct ").and_then(|rest| rest.strip_suffix(" {")) {
            let mut head = vec![format!("  type, bind(c), public :: {name}")];
            head.extend(comment_lines("    ", &comment));
            components = Some(head);
        } else if let Some(mut body) = components.take() {
            let Some(name) = item.strip_prefix("} ") else {
                let argument = Declaration::parse(item)?;
                let name = argument.name.replace('[', "(").replace(']', ")");
                let kind = if argument.base == "double" { "real(mslip_real)" } else { "integer(mslip_int)" };
                body.extend(commented("    ", format!("{kind} :: {name} = 0"), &comment));
                components = Some(body);
                continue;
            };
            if body.iter().any(|line| line.contains("real(mslip_real) :: reserved(")) {
                lines.extend(body);
                lines.push(format!("  end type {name}"));
            }
        }
    }
    Ok(lines)
}

/// The interfaces of the C functions, with `c_` in place of the prefix.
fn interfaces(prototypes: &[Prototype]) -> Result<Vec<String>, String> {
    let mut lines = vec!["  interface".to_owned()];
    for prototype in prototypes {
        lines.push(String::new());
        lines.extend(interface(prototype)?);
    }
    lines.extend([String::new(), "  end interface".to_owned()]);
    Ok(lines)
}

fn interface(prototype: &Prototype) -> Result<Vec<String>, String> {
    let Prototype { result: Declaration { name, base, .. }, arguments, .. } = prototype;
    let (name, base) = (*name, *base);
    let short = name.replacen("mslip_", "c_", 1);

    // Without pointers there are no side effects, nor in a function that returns a text: the result may dimension a variable.
    let is_pure = base == "char" || base != "void" && arguments.iter().all(|argument| !argument.pointer);
    let prefix = if is_pure { "pure " } else { "" };
    let unit = if base == "void" { "subroutine" } else { "function" };
    let kind = match base {
        "void" => String::new(),
        "char" => "type(c_ptr) ".to_owned(),
        _ => format!("{} ", scalar(base)?),
    };
    let names: Vec<&str> = arguments.iter().map(|argument| argument.name).collect();
    let names = names.join(", ");
    let mut lines = wrapped("    ", &format!("{prefix}{kind}{unit} {short}({names}) bind(c,{UNBROKEN}name='{name}')"));
    lines.push("      import".to_owned());

    // One declaration for all arguments of a type.
    let mut declarations: Vec<(String, Vec<String>)> = Vec::new();
    for argument in arguments {
        let (kind, dummy) = dummy(argument, prototype.is_counted(argument))?;
        match declarations.iter_mut().find(|declared| declared.0 == kind) {
            Some(declared) => declared.1.push(dummy),
            None => declarations.push((kind, vec![dummy])),
        }
    }
    for (kind, dummies) in declarations {
        lines.extend(wrapped("      ", &format!("{kind} :: {}", dummies.join(", "))));
    }
    lines.push(format!("    end {unit} {short}"));
    Ok(lines)
}

fn scalar(base: &str) -> Result<&'static str, String> {
    match base {
        "size_t" => Ok("integer(c_size_t)"),
        "int32_t" => Ok("integer(c_int32_t)"),
        "double" => Ok("real(c_double)"),
        _ => Err(format!("no Fortran type is known for {base}")),
    }
}

/// The type and the dummy argument of an interface. Arrays that are only read are passed as such, so that the compiler makes
/// sections with strides contiguous; an array that may be absent, or may be an output as well, is passed by its C address.
fn dummy(argument: &Declaration, counted: bool) -> Result<(String, String), String> {
    let Declaration { name, base, pointer, constant } = *argument;
    let intent = if constant { "intent(in)" } else { "intent(inout)" };
    if !pointer {
        Ok((format!("{}, value", scalar(base)?), name.to_owned()))
    } else if base.starts_with("mslip_") {
        Ok((format!("type({base}), {intent}"), format!("{name}{}", if counted { "(*)" } else { "" })))
    } else if base == "double" && constant && !name.ends_with("_old") {
        Ok((format!("{}, {intent}", scalar(base)?), format!("{name}(*)")))
    } else {
        scalar(base).map(|_| ("type(c_ptr), value".to_owned(), name.to_owned()))
    }
}

/// The lines of the header that are not comments, each with the comment before it.
fn items(header: &str) -> Vec<(&str, String)> {
    let mut items = Vec::new();
    let mut comment = Vec::new();
    for line in header.lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("//") {
            comment.push(text.trim());
        } else {
            items.push((line, comment.join(" ")));
            comment.clear();
        }
    }
    items
}

/// A statement with its comment, on the same line if that is not too long.
pub fn commented(indent: &str, statement: String, comment: &str) -> Vec<String> {
    let line = format!("{indent}{statement}  !! {comment}");
    let line = if comment.is_empty() { indent.to_owned() + &statement } else { line };
    if line.chars().count() <= LONGEST {
        return vec![line];
    }
    let mut lines = vec![indent.to_owned() + &statement];
    lines.extend(comment_lines(&format!("{indent}  "), comment));
    lines
}

pub fn comment_lines(indent: &str, comment: &str) -> Vec<String> {
    broken(comment, WIDTH - indent.len() - 3).into_iter().map(|line| format!("{indent}!! {line}")).collect()
}

/// A statement, continued if it is too long.
pub fn wrapped(indent: &str, statement: &str) -> Vec<String> {
    let parts = broken(statement, WIDTH - indent.len() - 4);
    let last = parts.len() - 1;
    let line = |(number, part): (usize, String)| {
        let (start, end) = (if number > 0 { "  " } else { "" }, if number < last { " &" } else { "" });
        format!("{indent}{start}{}{end}", part.replace(UNBROKEN, " "))
    };
    parts.into_iter().enumerate().map(line).collect()
}

/// A text, broken at blanks into lines of a width.
pub fn broken(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_ascii_whitespace() {
        let line = lines.last_mut().expect("there is a line");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
