//! The functions of the interface: declarations and comments from the C header, lengths and statuses from `interface.txt`.

use std::collections::HashMap;
use std::mem::{replace, take};

/// The facts that types do not state.
const FACTS: &str = include_str!("../interface.txt");

/// The version of the library, and of the interface, since which a function exists.
pub fn since(name: &str) -> &'static str {
    let mut lines = FACTS.lines().filter(|line| line.split([',', ' ']).next() == Some(name));
    lines
        .next()
        .and_then(|line| line.split(", ").find_map(|word| word.strip_prefix("since ")))
        .unwrap_or("0.1.0 (interface 6)")
}

/// A C declaration: an argument, a component, or the name and result of a function.
#[derive(Clone)]
pub struct Declaration<'a> {
    pub name: &'a str,
    pub base: &'a str,
    pub pointer: bool,
    pub constant: bool,
}

impl<'a> Declaration<'a> {
    pub fn parse(text: &'a str) -> Result<Declaration<'a>, String> {
        let start = text.rfind([' ', '*']).ok_or(format!("no declaration: {text}"))? + 1;
        let (kind, name) = text.split_at(start);
        let constant = kind.trim_start().starts_with("const ");
        let base = kind.trim_matches([' ', '*']);
        let base = base.strip_prefix("const ").unwrap_or(base);
        let base = base.strip_prefix("struct ").unwrap_or(base);
        Ok(Declaration { name, base, pointer: kind.contains('*'), constant })
    }
}

/// A function as declared in the header: its name and result, its arguments, and the paragraphs of its comment.
pub struct Prototype<'a> {
    pub result: Declaration<'a>,
    pub arguments: Vec<Declaration<'a>>,
    pub comment: Vec<String>,
}

impl Prototype<'_> {
    /// Structures are arrays if their number is an argument, or they are parts.
    pub fn is_counted(&self, argument: &Declaration) -> bool {
        argument.name == "parts"
            || self.arguments.iter().any(|count| count.name.strip_prefix("n_") == Some(argument.name))
    }
}

/// A statement of the header on one line: a directive of the preprocessor, a function, the start or end of a structure, or a
/// component of it. The paragraphs of the comment before it.
pub struct Item {
    pub text: String,
    pub comment: Vec<String>,
}

pub fn items(header: &str) -> Vec<Item> {
    let (mut items, mut text, mut comment) = (Vec::new(), String::new(), vec![String::new()]);
    // The convention of the whole header is in another kind of comment.
    for line in header.lines().map(str::trim).filter(|line| !line.starts_with('*') && !line.starts_with("/*")) {
        match (line.strip_prefix("//").map(str::trim), comment.last_mut()) {
            (Some(""), _) => comment.push(String::new()),
            (Some(words), Some(paragraph)) => *paragraph = format!("{paragraph} {words}").trim().to_owned(),
            _ => text = format!("{text} {line}").trim().to_owned(),
        }
        if !text.is_empty() && (line.starts_with(['#', '}']) || line.ends_with([';', '{'])) {
            items.push(Item { text: take(&mut text), comment: replace(&mut comment, vec![String::new()]) });
        }
    }
    items
}

/// The functions: their declarations without arguments, their arguments, and comments.
pub fn declarations(items: &[Item]) -> impl Iterator<Item = (&str, &str, &[String])> {
    items.iter().filter_map(|item| {
        let (head, arguments) = item.text.strip_suffix(");")?.split_once('(')?;
        Some((head, arguments, &item.comment[..]))
    })
}

pub fn prototypes(items: &[Item]) -> Result<Vec<Prototype<'_>>, String> {
    let mut prototypes = Vec::new();
    for (head, arguments, comment) in declarations(items) {
        let arguments = arguments.split(',').map(str::trim).filter(|text| *text != "void").map(Declaration::parse);
        let (result, arguments) = (Declaration::parse(head)?, arguments.collect::<Result<_, _>>()?);
        prototypes.push(Prototype { result, arguments, comment: comment.to_vec() });
    }
    Ok(prototypes)
}

/// An argument of a function.
#[derive(Clone)]
pub struct Argument<'a> {
    pub declaration: Declaration<'a>,
    /// An array of structures.
    pub counted: bool,
    /// Letters of the extents of an array of doubles, the first the fastest; none of a single one, a state or a buffer.
    pub extents: String,
    pub required: bool,
    pub comment: &'a str,
    /// Name of the constant that is the status of an invalid value; `MSLIP_OK` if none is.
    pub status: &'a str,
}

impl Argument<'_> {
    pub fn name(&self) -> &str {
        self.declaration.name
    }

    /// A value, or an array of values, that the function reads.
    pub fn is_input(&self) -> bool {
        let Declaration { base, pointer, constant, .. } = self.declaration;
        base == "double" && (!pointer || constant) && !self.is_memory()
    }

    /// A state or workspace.
    pub fn is_memory(&self) -> bool {
        self.declaration.pointer && (self.name().starts_with("state") || self.name() == "workspace")
    }

    /// An array of values, or a value, that the function writes.
    pub fn is_output(&self) -> bool {
        let Declaration { base, pointer, constant, .. } = self.declaration;
        base == "double" && pointer && !constant && !self.is_memory()
    }

    /// A length of an array, which the array carries in Fortran.
    pub fn is_length(&self) -> bool {
        let Declaration { name, pointer, .. } = self.declaration;
        !pointer && (name == "n" || name.starts_with("n_") || name.ends_with("_length"))
    }
}

/// A function with all facts.
pub struct Function<'a> {
    pub name: &'a str,
    pub result: &'a str,
    pub arguments: Vec<Argument<'a>>,
    /// Paragraphs of the comment in the header.
    pub comment: Vec<String>,
    words: Vec<&'a str>,
    /// Title of the section that begins with the function.
    pub section: Vec<&'a str>,
}

impl Function<'_> {
    pub fn has(&self, word: &str) -> bool {
        self.words.contains(&word)
    }

    pub fn argument(&self, name: &str) -> Option<&Argument<'_>> {
        self.arguments.iter().find(|argument| argument.name() == name)
    }

    pub fn is_batch(&self) -> bool {
        self.argument("index").is_some()
    }

    /// Letters of the extents of all arguments.
    pub fn letters(&self) -> String {
        self.arguments.iter().map(|argument| argument.extents.as_str()).collect()
    }
}

/// What `interface.txt` states of an argument of a function.
#[derive(Clone, Default)]
struct Fact<'a> {
    name: &'a str,
    extents: String,
    required: bool,
    comment: &'a str,
}

impl<'a> Fact<'a> {
    fn parse(line: &'a str) -> Result<Fact<'a>, String> {
        let (head, comment) = line.split_once(':').unwrap_or((line, ""));
        let required = head.ends_with('!');
        let (name, extents) = head.trim_end_matches([' ', '!', ')']).split_once(" (").unwrap_or((head, ""));
        let name = name.trim_end_matches([' ', '!']);
        let extents: String = extents.chars().filter(|letter| letter.is_alphabetic()).collect();
        match extents.trim_matches(['n', 'm', 'k', 'p', 'q']) {
            "" => Ok(Fact { name, extents, required, comment: comment.trim() }),
            _ => Err(format!("unknown extents: {line}")),
        }
    }
}

struct Entry<'a> {
    name: &'a str,
    words: Vec<&'a str>,
    facts: Vec<Fact<'a>>,
    section: Vec<&'a str>,
}

/// The functions in the order of `interface.txt`.
pub fn functions<'a>(prototypes: &'a [Prototype<'a>]) -> Result<Vec<Function<'a>>, String> {
    let (mut common, mut statuses) = (HashMap::new(), HashMap::new());
    let (mut entries, mut section): (Vec<Entry>, _) = (Vec::new(), Vec::new());
    for line in FACTS.lines().filter(|line| !line.starts_with('#') && !line.is_empty()) {
        if let Some(title) = line.strip_prefix("---") {
            section.push(title.trim());
        } else if let Some(fact) = line.strip_prefix("    ") {
            entries.last_mut().ok_or("an argument without a function")?.facts.push(Fact::parse(fact)?);
        } else if line.starts_with("mslip_") {
            let mut words = line.split(", ");
            let (name, other) =
                words.next().map(|name| name.split_once(" = ").unwrap_or((name, ""))).unwrap_or_default();
            let mut words: Vec<&str> = words.collect();
            let mut facts = Vec::new();
            if !other.is_empty() {
                facts = entries.iter().find(|entry| entry.name == other).ok_or(format!("no {other}"))?.facts.clone();
                if let Some(place) = words.iter().position(|word| *word == "n") {
                    words.remove(place);
                    facts.iter_mut().for_each(|fact| fact.extents.push('n'));
                }
            }
            entries.push(Entry { name, words, facts, section: take(&mut section) });
        } else if let Some((name, comment)) = line.split_once(": ") {
            common.insert(name, comment);
        } else if let Some((name, status)) = line.split_once(' ') {
            statuses.insert(name, status);
        } else {
            return Err(format!("not understood: {line}"));
        }
    }
    let missing = prototypes.iter().find(|prototype| entries.iter().all(|entry| entry.name != prototype.result.name));
    if let Some(prototype) = missing {
        return Err(format!("{} is missing", prototype.result.name));
    }
    entries.into_iter().map(|entry| function(entry, prototypes, &common, &statuses)).collect()
}

fn function<'a>(
    Entry { name, words, mut facts, section }: Entry<'a>,
    prototypes: &'a [Prototype<'a>],
    common: &HashMap<&'a str, &'a str>,
    statuses: &HashMap<&'a str, &'a str>,
) -> Result<Function<'a>, String> {
    let prototype = prototypes.iter().find(|prototype| prototype.result.name == name);
    let prototype = prototype.ok_or(format!("{name} is not in the source"))?;
    let mut arguments = Vec::new();
    for declaration in &prototype.arguments {
        let short = declaration.name;
        let fact = facts.iter().position(|fact| fact.name == short).map(|place| facts.remove(place));
        let common_name = if short == "p" { "parameters" } else { short };
        // The status of a state is that of all states, of contacts that of a contact.
        let kind = short.split("_old").next().unwrap_or(short);
        let status = [short, kind, kind.trim_end_matches('s')].iter().find_map(|name| statuses.get(name));
        let is_stated = fact.is_some() || words.contains(&"by hand");
        let Fact { extents, required, comment, .. } = fact.unwrap_or_default();
        let argument = Argument {
            declaration: declaration.clone(),
            counted: prototype.is_counted(declaration),
            extents,
            required,
            comment: if comment.is_empty() { common.get(common_name).copied().unwrap_or("") } else { comment },
            status: status.copied().unwrap_or("MSLIP_OK"),
        };
        if (argument.is_input() || argument.is_output()) && !is_stated {
            return Err(format!("{name}: {short} is missing"));
        }
        if !argument.extents.is_empty() && (!declaration.pointer || argument.is_memory()) {
            return Err(format!("{name}: {short} is no array of values"));
        }
        if argument.comment.is_empty() && !argument.is_length() && !words.contains(&"by hand") {
            return Err(format!("{name}: {short} has no comment"));
        }
        arguments.push(argument);
    }
    match facts.first() {
        Some(fact) => Err(format!("{name}: {} is not in the source", fact.name)),
        None => {
            let (result, comment) = (prototype.result.base, prototype.comment.clone());
            Ok(Function { name, result, arguments, comment, words, section })
        }
    }
}
