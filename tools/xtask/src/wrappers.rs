//! The procedures of the Fortran module that have the common shape: the arguments that C requires, `status`, the optional ones;
//! lengths are those of the arrays.

use crate::fortran::{comment_lines, commented, wrapped};
use crate::interface::{Argument, Function};

/// Variants of a procedure.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Array,
    /// Of one value instead of n.
    Scalar,
    /// The new state replaces the old one.
    Advance,
}

/// The public names, the interfaces of procedures of one and of n values, and the procedures.
pub fn blocks(functions: &[Function]) -> [(&'static str, Vec<String>); 3] {
    let (mut public, mut interfaces, mut procedures) = (Vec::new(), Vec::new(), Vec::new());
    for function in functions {
        if !function.section.is_empty() {
            procedures.extend([String::new(), format!("  ! {}", "-".repeat(117))]);
            procedures.extend(function.section.iter().map(|line| format!("  ! {line}").trim_end().to_owned()));
        }
        if function.has("by hand") {
            continue;
        }
        let name = function.name;
        let mut forms = vec![(Form::Array, name.to_owned())];
        if function.has("scalar") {
            let short = name.trim_start_matches("mslip_");
            let procedure = |end| format!("{short}_{end}");
            forms = vec![(Form::Array, procedure("array")), (Form::Scalar, procedure("scalar"))];
            interfaces.extend([String::new(), format!("  interface {name}")]);
            interfaces.extend(comment_lines("    ", &description(function, Form::Array)[0]));
            interfaces.push(format!("    module procedure {}, {}", forms[0].1, forms[1].1));
            interfaces.push(format!("  end interface {name}"));
        }
        public.push(format!("  public :: {name}"));
        if function.arguments.iter().any(is_new_state) {
            let advance = name_of(function, Form::Advance);
            public.push(format!("  public :: {advance}"));
            forms.push((Form::Advance, advance));
        }
        for (form, name) in forms {
            procedures.push(String::new());
            procedures.extend(Procedure { function, form, name: &name }.lines());
        }
    }
    [("public", public), ("interfaces", interfaces), ("procedures", procedures)]
}

/// The forms of a function, and the names by which they are called.
fn forms(function: &Function) -> Vec<Form> {
    let scalar = function.has("scalar").then_some(Form::Scalar);
    let advance = function.arguments.iter().any(is_new_state).then_some(Form::Advance);
    [Some(Form::Array), scalar, advance].into_iter().flatten().collect()
}

/// The procedures with outputs, for the test of invalid input: a table, and the calls.
pub fn test(functions: &[Function]) -> [(&'static str, Vec<String>); 2] {
    let (mut rows, mut calls) = (Vec::new(), Vec::new());
    let with_outputs = |function: &&Function| {
        function.arguments.iter().any(Argument::is_output)
            && !function.name.ends_with("_error")
            && !function.has("by hand")
            && !function.has("two inputs")
    };
    for function in functions.iter().filter(with_outputs) {
        for form in forms(function) {
            let procedure = Procedure { function, form, name: &name_of(function, form) };
            rows.push(procedure.row());
            calls.extend(wrapped("    ", &format!("case ({}); {}", rows.len(), procedure.call())));
        }
    }
    let count = rows.len();
    let rows =
        rows.into_iter().enumerate().map(|(i, row)| format!("    {row}{}", if i + 1 < count { ", &" } else { "]" }));
    let head = format!("  type(procedure_info), parameter :: procedures({count}) = [ &");
    [("procedures", std::iter::once(head).chain(rows).collect()), ("calls", calls)]
}

fn name_of(function: &Function, form: Form) -> String {
    let name = function.name;
    match form {
        Form::Advance => name.strip_suffix("_update").unwrap_or(name).to_owned() + "_advance",
        _ => name.to_owned(),
    }
}

fn is_new_state(argument: &Argument) -> bool {
    argument.name().ends_with("_new")
}

fn is_old_state(argument: &Argument) -> bool {
    argument.name().ends_with("_old")
}

/// The comment of the header without sentences that concern C only, and without the paragraphs on status and memory.
fn description(function: &Function, form: Form) -> Vec<String> {
    if form == Form::Advance {
        return vec![format!("`{}` in place: the new state replaces the old one.", function.name)];
    }
    let paragraphs = function.comment.iter().filter(|text| !text.starts_with("Returns "));
    let paragraphs = paragraphs.map(|text| {
        let of_c = |sentence: &&str| ["NULL", "alias", "MSLIP_BY_"].iter().any(|word| sentence.contains(word));
        let kept: Vec<&str> = sentences(text).into_iter().filter(|sentence| !of_c(sentence)).collect();
        let mut text = String::new();
        // An index is in parentheses, a unit in brackets.
        let mut of_index = false;
        for letter in kept.join(" ").chars() {
            let index = letter == '[' && text.ends_with(|before: char| before.is_alphanumeric());
            of_index |= index;
            text.push(if index {
                '('
            } else if letter == ']' && of_index {
                ')'
            } else {
                letter
            });
            of_index &= letter != ']';
        }
        text
    });
    paragraphs.filter(|text| !text.is_empty()).collect()
}

/// A sentence ends with a full stop before a letter that is not lower case, or a name of the interface.
fn sentences(text: &str) -> Vec<&str> {
    let (mut sentences, mut start) = (Vec::new(), 0);
    for (place, _) in text.match_indices(". ") {
        if text[place + 2..].starts_with(char::is_alphabetic) {
            sentences.push(&text[start..=place]);
            start = place + 2;
        }
    }
    sentences.push(&text[start..]);
    sentences
}

struct Procedure<'a> {
    function: &'a Function<'a>,
    form: Form,
    name: &'a str,
}

impl Procedure<'_> {
    fn lines(&self) -> Vec<String> {
        if self.function.result == "size_t" {
            return self.length();
        }
        let (optional, required): (Vec<&Argument>, Vec<&Argument>) =
            self.dummies().partition(|argument| is_optional(argument));
        let names = |arguments: &[&Argument]| arguments.iter().map(|argument| self.dummy(argument)).collect::<Vec<_>>();
        let names = [names(&required), vec!["status".to_owned()], names(&optional)].concat().join(", ");
        let mut lines = wrapped("  ", &format!("subroutine {}({names})", self.name));
        lines.extend(self.description());
        lines.extend(required.iter().flat_map(|argument| self.declaration(argument)));
        lines.extend(commented("    ", "integer(mslip_int), intent(out) :: status".to_owned(), &self.statuses()));
        lines.extend(optional.iter().flat_map(|argument| self.declaration(argument)));
        lines.extend(self.body());
        lines.push(format!("  end subroutine {}", self.name));
        lines
    }

    /// Name, statuses of an invalid scalar and of an invalid element of the array, shapes of the outputs, memory.
    fn row(&self) -> String {
        let function = self.function;
        let input = function.arguments.iter().find(|argument| argument.is_input() && argument.declaration.pointer);
        let value = function.arguments.iter().find(|argument| argument.is_input() && !argument.declaration.pointer);
        let (value, input) = if self.form == Form::Scalar { (input, None) } else { (value, input) };
        let status = |argument: Option<&Argument>| argument.map_or("none", |argument| argument.status).to_owned();
        let of_element = function.name.contains("element") || function.argument("element").is_some();
        let mut shapes: String = function
            .arguments
            .iter()
            .filter(|argument| argument.is_output())
            .map(|argument| {
                let extents = if self.form == Form::Scalar { "" } else { &argument.extents[..] };
                let letter = match (extents, of_element) {
                    ("", _) => 's',
                    ("n", _) => 'v',
                    ("k", false) => 'c',
                    ("kk", false) => 'j',
                    ("kn", false) => 'f',
                    ("kkn", false) => 'k',
                    ("pn", _) => 'q',
                    ("kp", _) => 'r',
                    ("m", _) => 'p',
                    ("mm", _) => 't',
                    ("mn", _) => 'a',
                    ("mmn", _) => 'b',
                    ("k", true) => 'd',
                    ("kk", true) => 'e',
                    ("kn", true) => 'g',
                    _ => 'h',
                };
                if argument.required { letter.to_ascii_uppercase() } else { letter }
            })
            .collect();
        if self.form != Form::Advance && function.arguments.iter().any(is_new_state) {
            shapes = format!("{shapes:4}{}", if function.is_batch() { 'B' } else { 'N' });
        }
        let memory = [("state", 's'), ("workspace", 'w'), ("table", 't')].into_iter();
        let mut memory =
            memory.filter(|(name, _)| function.arguments.iter().any(|a| a.is_memory() && a.name().starts_with(name)));
        let short = self.name.trim_start_matches("mslip_");
        let one = if self.form == Form::Scalar { ", one" } else { "" };
        let flag = |name: &str, holds: bool| if holds { format!(", {name}=.true.") } else { String::new() };
        format!(
            "procedure_info('{short}{one}', {}, {}, '{shapes}', '{}'{}{})",
            status(value),
            status(input),
            memory.next().map_or(' ', |memory| memory.1),
            flag("batch", function.is_batch()),
            flag("element", of_element)
        )
    }

    /// The call with the arguments of the test.
    fn call(&self) -> String {
        let mut outputs = 0;
        let mut actual = |argument: &Argument| match argument.name() {
            "contact" | "element" => format!("{}s(1)", argument.name()),
            name if name.ends_with("_new") => format!("out(5)%{}", if self.rank(argument) == 2 { 'm' } else { 'v' }),
            name if argument.is_memory() => name.trim_end_matches("_old").to_owned(),
            _ if argument.is_input() => match &argument.extents[..] {
                _ if self.rank(argument) == 0 => "scalar",
                "n" => "x",
                "m" => "vector",
                "mn" => "vectors",
                "k" => "u(:, 1)",
                _ => "u",
            }
            .to_owned(),
            _ if argument.is_output() => {
                outputs += 1;
                format!("out({outputs})%{}", ["s", "v", "m", "t"][self.rank(argument)])
            }
            name => name.to_owned(),
        };
        let (mut required, mut optional) = (Vec::new(), Vec::new());
        for argument in self.dummies() {
            let list = if is_optional(argument) { &mut optional } else { &mut required };
            list.push(actual(argument));
        }
        format!("call {}({})", self.name, [required, vec!["status".to_owned()], optional].concat().join(", "))
    }

    /// The function of a length, which may dimension an array.
    fn length(&self) -> Vec<String> {
        let names: Vec<String> = self.dummies().map(|argument| self.dummy(argument)).collect();
        let mut lines = wrapped("  ", &format!("pure function {}({}) result(length)", self.name, names.join(", ")));
        lines.extend(self.description());
        lines.extend(self.dummies().flat_map(|argument| self.declaration(argument)));
        lines.extend([
            "    integer(mslip_size) :: length  !! The length. It may dimension an array.".to_owned(),
            String::new(),
        ]);
        let mut value = format!("{}({})", self.c_name(), names.join(", "));
        if names.iter().any(|name| name == "rule") {
            lines.push("    ! A C length beyond the largest integer of this kind arrives negative.".to_owned());
            value = format!("max({}, 0_mslip_size)", value.replace("rule)", "rule_or_default(rule))"));
        }
        lines.extend(wrapped("    ", &format!("length = {value}")));
        lines.push(format!("  end function {}", self.name));
        lines
    }

    fn c_name(&self) -> String {
        self.function.name.replacen("mslip_", "c_", 1)
    }

    fn dummies(&self) -> impl Iterator<Item = &Argument<'_>> {
        let arguments = self.function.arguments.iter().filter(|argument| !argument.is_length());
        arguments.filter(|argument| self.form != Form::Advance || !is_new_state(argument))
    }

    fn dummy(&self, argument: &Argument) -> String {
        match argument.name() {
            "p" => "parameters".to_owned(),
            name if self.form == Form::Advance => name.trim_end_matches("_old").to_owned(),
            name => name.to_owned(),
        }
    }

    fn description(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (number, paragraph) in description(self.function, self.form).iter().enumerate() {
            lines.extend((number > 0).then(|| "    !!".to_owned()));
            lines.extend(comment_lines("    ", paragraph));
        }
        lines
    }

    /// The codes as the header names them; no pointer is NULL.
    fn statuses(&self) -> String {
        let comment = self.function.comment.iter().find_map(|text| text.strip_prefix("Returns "));
        let codes =
            comment.unwrap_or("an error.").replace("MSLIP_NULL_POINTER, ", "").replace("MSLIP_NULL_POINTER or ", "");
        format!("`MSLIP_OK`, {}{codes}", if codes.contains(" or ") { "" } else { "or " })
    }

    fn rank(&self, argument: &Argument) -> usize {
        match argument.name() {
            "index" | "active" | "workspace" | "table" => 1,
            name if name.starts_with("states_") => 2,
            _ if argument.is_memory() => 1,
            _ if argument.counted => 1,
            _ if self.form == Form::Scalar => 0,
            _ => argument.extents.len(),
        }
    }

    fn declaration(&self, argument: &Argument) -> Vec<String> {
        let declared = &argument.declaration;
        let in_place = self.form == Form::Advance && is_old_state(argument);
        let is_read = declared.constant && !in_place || !declared.pointer;
        let kind = match declared.base {
            "double" => "real(mslip_real)".to_owned(),
            "int32_t" => "integer(mslip_int)".to_owned(),
            "size_t" => "integer(mslip_size)".to_owned(),
            structure => format!("type({structure})"),
        };
        let rank = self.rank(argument);
        let mut attributes = vec![kind, format!("intent({})", if is_read { "in" } else { "inout" })];
        attributes.extend(is_optional(argument).then(|| "optional".to_owned()));
        let is_address = !is_read && declared.base == "double" || is_old_state(argument) || argument.name() == "active";
        attributes.extend(is_address.then(|| "target".to_owned()));
        let contiguous = rank > 0 && (is_address || argument.name() == "table");
        attributes.extend(contiguous.then(|| "contiguous".to_owned()));
        let shape = if rank > 0 { format!("({})", vec![":"; rank].join(", ")) } else { String::new() };
        let mut comment = argument.comment.to_owned();
        if in_place {
            comment = comment.replace(" before the step", " before and after the step");
        }
        if rank > 1 && argument.extents.len() > 1 {
            let extents: Vec<String> = argument.extents.chars().map(|letter| letter.to_string()).collect();
            comment = format!("({}): {comment}", extents.join(", "));
        }
        let statement = format!("{} :: {}{shape}", attributes.join(", "), self.dummy(argument));
        commented("    ", statement, &comment)
    }

    /// The variables, the checks of sizes, and the call.
    fn body(&self) -> Vec<String> {
        let function = self.function;
        let letters: Vec<char> =
            ['k', 'm', 'n'].into_iter().filter(|letter| function.letters().contains(*letter)).collect();
        let mut extents: Vec<String> = letters.iter().filter_map(|letter| self.extent(*letter)).collect();
        if self.form == Form::Scalar {
            extents.clear();
        }
        let mut checks = Vec::new();
        let mut pointers = 0;
        let mut actual: Vec<String> = Vec::new();
        for argument in &function.arguments {
            let name = argument.name();
            if self.form == Form::Advance && is_new_state(argument) {
                let old = function.arguments.iter().position(is_old_state).map(|place| actual[place].clone());
                actual.push(old.unwrap_or_default());
                continue;
            }
            let name = if name.ends_with("_old") { self.dummy(argument) } else { name.to_owned() };
            let shape = self.shape(argument);
            let is_checked = !shape.is_empty() && !argument.is_input() && argument.declaration.pointer;
            actual.push(if is_checked {
                pointers += 1;
                let present = if is_optional(argument) { format!("if (present({name})) ") } else { String::new() };
                checks.push(if name == "index" {
                    let laws = function.arguments.iter().find(|argument| argument.counted).map_or("", Argument::name);
                    format!(
                        "call check_index(size({laws}, kind=mslip_size), n, index, from_zero, ptr({pointers}), status)"
                    )
                } else {
                    format!("{present}call check_array({name}, {shape}, ptr({pointers}), status)")
                });
                format!("ptr({pointers})")
            } else {
                self.actual(argument, &name)
            });
        }
        // The shapes of the inputs, but for the extents that they define.
        if self.form != Form::Scalar {
            let inputs =
                function.arguments.iter().filter(|argument| argument.is_input() && argument.declaration.pointer);
            let first = usize::from(checks.first().is_some_and(|check| check.starts_with("call check_index")));
            for (number, (of_coefficients, check)) in inputs.filter_map(|input| self.check_of_input(input)).enumerate()
            {
                // Another workspace disagrees with all arrays: the last error stays.
                checks.insert(if of_coefficients { checks.len() } else { first + number }, check);
            }
            if function.is_batch() && letters.contains(&'m') {
                checks.push(
                    "if (status == MSLIP_OK) call check_components(elements, m, n, index, active, status)".to_owned(),
                );
            }
        }
        self.statements(&extents, &checks, pointers, &actual)
    }

    fn statements(&self, extents: &[String], checks: &[String], pointers: usize, actual: &[String]) -> Vec<String> {
        let mut lines = vec![String::new()];
        let call = format!("status = {}({})", self.c_name(), actual.join(", "));
        let of_workspace = extents.iter().any(|extent| extent.contains("call "));
        let of_index = checks.iter().any(|check| check.contains("check_index"));
        if !extents.is_empty() {
            let names: Vec<String> = extents.iter().filter_map(|extent| Some(letter_of(extent)?.to_string())).collect();
            lines.push(format!("    integer(mslip_size) :: {}", names.join(", ")));
        }
        lines.extend(of_index.then(|| "    integer(mslip_int), allocatable, target :: from_zero(:)".to_owned()));
        lines.extend((pointers > 0).then(|| format!("    type(c_ptr) :: ptr({pointers})")));
        if lines.len() > 1 {
            lines.push(String::new());
        }
        lines.extend(extents.iter().flat_map(|extent| extent.split('\n')).map(|line| format!("    {line}")));
        lines.extend((pointers > 0).then(|| "    ptr = c_null_ptr".to_owned()));
        let is_tabulated = self.function.name.contains("tabulated");
        if is_tabulated {
            lines.push("    status = table_status(table)".to_owned());
        } else if !of_workspace && !of_index && !checks.is_empty() {
            lines.push("    status = MSLIP_OK".to_owned());
        }
        lines.extend(checks.iter().flat_map(|check| wrapped("    ", check)));
        let is_checked = is_tabulated || of_workspace || !checks.is_empty();
        lines.extend(wrapped("    ", &format!("{}{call}", if is_checked { "if (status == MSLIP_OK) " } else { "" })));
        lines
    }

    /// The statements that define an extent.
    fn extent(&self, letter: char) -> Option<String> {
        let function = self.function;
        let is_given = |argument: &&Argument| !is_optional(argument) && argument.extents.contains(letter);
        let size = |argument: &Argument| {
            let dimension = argument.extents.find(letter)? + 1;
            Some(self.size(argument, dimension))
        };
        let given = function.arguments.iter().find(is_given).and_then(size);
        match letter {
            'k' => {
                let of_element = function.arguments.iter().any(|argument| argument.declaration.base == "mslip_element");
                let count = if of_element { "count_element_coefficients" } else { "count_coefficients" };
                Some(format!("call {count}(workspace, k, status)\nif (status /= MSLIP_OK) return"))
            }
            'm' if !function.is_batch() => Some(format!("m = components(element, {})", given?)),
            _ => Some(format!("{letter} = {}", given?)),
        }
    }

    fn size(&self, argument: &Argument, dimension: usize) -> String {
        let name = self.dummy(argument);
        if self.rank(argument) == 1 {
            format!("size({name}, kind=mslip_size)")
        } else {
            format!("size({name}, {dimension}, mslip_size)")
        }
    }

    /// The required shape of an argument: an extent or a list; empty if it is not an array of known size.
    fn shape(&self, argument: &Argument) -> String {
        let old = self.function.arguments.iter().find(|argument| is_old_state(argument));
        let shape: Vec<String> = match argument.name() {
            "index" | "active" => vec!["n".to_owned()],
            "state_new" => old.map(|old| self.size(old, 1)).into_iter().collect(),
            name if name.starts_with("states_") => old.map_or(vec![], |old| vec![self.size(old, 1), "n".to_owned()]),
            _ if self.rank(argument) == 0 || argument.is_memory() => vec![],
            _ => {
                let extent = |letter| match letter {
                    'p' => "int(MSLIP_PARAMETER_COUNT, mslip_size)".to_owned(),
                    letter => String::from(letter),
                };
                argument.extents.chars().map(extent).collect()
            }
        };
        if shape.len() > 1 { format!("[{}]", shape.join(", ")) } else { shape.concat() }
    }

    /// The check of the size of an input, and whether it is that of coefficients.
    fn check_of_input(&self, input: &Argument) -> Option<(bool, String)> {
        let mut inputs = self.function.arguments.iter().filter(|other| other.is_input() && other.declaration.pointer);
        // The first one defines n. The elements of a batch are checked last.
        let is_second = inputs.next().is_some_and(|first| first.name() != input.name());
        let is_checked = |letter: &char| match letter {
            'k' => true,
            'm' => !self.function.is_batch(),
            _ => is_second,
        };
        let letter = input.extents.chars().find(is_checked)?;
        let code = if letter == 'k' { "MSLIP_BAD_COEFFICIENTS" } else { "MSLIP_BAD_ARRAY_SIZE" };
        Some((letter == 'k', format!("if ({} /= {letter}) status = {code}", self.size(input, 1))))
    }

    /// The actual argument of an argument whose shape is not checked.
    fn actual(&self, argument: &Argument, name: &str) -> String {
        let declared = &argument.declaration;
        if let Some(laws) = name.strip_prefix("n_") {
            return format!("size({laws}, kind=mslip_size)");
        }
        match name {
            "p" => "parameters".to_owned(),
            "n" if self.form == Form::Scalar => "1_mslip_size".to_owned(),
            "rule" => "rule_or_default(rule)".to_owned(),
            _ if argument.is_length() && name != "n" => {
                let array = name.trim_end_matches("_length");
                let is_array = |argument: &&Argument| {
                    argument.is_memory() && argument.name().starts_with(array) && !argument.is_length()
                };
                let array = self.function.arguments.iter().find(is_array);
                array.map_or(String::new(), |array| self.size(array, 1))
            }
            _ if argument.is_input() && declared.pointer && self.form == Form::Scalar => format!("[{name}]"),
            _ if declared.base != "double" || !declared.pointer || declared.constant && !is_old_state(argument) => {
                name.to_owned()
            }
            _ => format!("address_of({name})"),
        }
    }
}

fn letter_of(extent: &str) -> Option<char> {
    if extent.starts_with("call ") { Some('k') } else { extent.chars().next() }
}

fn is_optional(argument: &Argument) -> bool {
    matches!(argument.name(), "rule" | "index" | "active") || argument.is_output() && !argument.required
}
