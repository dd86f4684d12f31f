//! Tables and values of a TOML document. Each knows its place in the text, so that every error has one.
//!
//! The crate `toml` parses the text. Its values are read by hand, so that every message names the key, the place and often
//! a correction, also one about a negative radius or an unknown key.

use super::error::Problem;
use super::suggestion::suggestion;
use crate::source::quote::{quoted, shown};
use glam::Vec3;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};

/// A value of the document, or what is wrong with it.
type Read<T> = Result<T, Problem>;

/// A table in which all keys are known.
#[derive(Debug)]
pub(super) struct Table<'t> {
    entries: &'t DeTable<'t>,
    /// The name in messages.
    name: String,
    pub(super) span: Range<usize>,
}

/// One value of the document.
#[derive(Clone, Debug)]
pub(super) struct Item<'t> {
    value: &'t DeValue<'t>,
    /// The name in messages: the key, followed by the number of the element, as in `eye[2]`.
    pub(super) name: String,
    pub(super) span: Range<usize>,
}

impl<'t> Table<'t> {
    /// A table that may have only the known keys. Messages call it `name`.
    pub(super) fn new(
        entries: &'t DeTable<'t>,
        name: String,
        span: Range<usize>,
        known: &[&str],
    ) -> Read<Table<'t>> {
        let unknown = entries.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        match unknown.min_by_key(|key| key.span().start) {
            None => Ok(Table { entries, name, span }),
            Some(key) => {
                let message = format!("{} has no key {}", shown(&name), quoted(key.get_ref()));
                let help = suggestion("keys", key.get_ref(), known.iter().copied());
                Err(Problem::new(key.span(), message).help(help))
            }
        }
    }

    /// The value of a key, if the table has it.
    pub(super) fn get(&self, key: &str) -> Option<Item<'t>> {
        self.entries.get_key_value(key).map(|(key, value)| Item::of(key, value))
    }

    /// The value of a key that the table must have. The message shows `example`.
    pub(super) fn need(&self, key: &str, example: &str) -> Read<Item<'t>> {
        self.get(key).ok_or_else(|| {
            Problem::new(self.span.clone(), format!("{} lacks {key}", shown(&self.name)))
                .help(format!("write for example {example}"))
        })
    }

    /// The place of a key, without its value; the place of the table if the key is missing.
    pub(super) fn span_of(&self, key: &str) -> Range<usize> {
        self.entries.get_key_value(key).map_or(self.span.clone(), |(key, _)| key.span())
    }

    /// The keys of this list that the table has, in the order of the file.
    pub(super) fn present<'k>(&self, keys: &[&'k str]) -> Vec<&'k str> {
        let mut present: Vec<&str> =
            keys.iter().copied().filter(|key| self.entries.contains_key(*key)).collect();
        present.sort_by_key(|key| self.span_of(key).start);
        present
    }

    /// The item of the only one of these keys that the table has. Messages call the table `name`, and show `example`.
    pub(super) fn exactly_one(&self, name: &str, keys: &[&str], example: &str) -> Read<Item<'t>> {
        let present = self.present(keys);
        let one_of = format!("one of {}", keys.join(", "));
        match present[..] {
            [key] => self.need(key, example),
            [] => Err(Problem::new(self.span.clone(), format!("{name} needs {one_of}"))
                .help(format!("write for example {example}"))),
            [first, second, ..] => {
                let message =
                    format!("{name} takes only {one_of}, and this one has {first} already");
                Err(Problem::new(self.span_of(second), message).help(format!("remove {second}")))
            }
        }
    }
}

impl<'t> Item<'t> {
    /// The value of a key.
    pub(super) fn of(key: &'t Spanned<impl AsRef<str>>, value: &'t Spanned<DeValue<'t>>) -> Self {
        let name = key.get_ref().as_ref().to_owned();
        Item { value: value.get_ref(), name, span: value.span() }
    }

    /// A problem with this value. The message is the value's name, followed by `what`.
    pub(super) fn problem(&self, what: impl std::fmt::Display) -> Problem {
        Problem::new(self.span.clone(), format!("{} {what}", shown(&self.name)))
    }

    /// A table that may have only the known keys.
    pub(super) fn table(&self, known: &[&str]) -> Read<Table<'t>> {
        let DeValue::Table(entries) = self.value else { return Err(self.not("a table")) };
        Table::new(entries, self.name.clone(), self.span.clone(), known)
    }

    /// The same; if the value is no table, the message shows `example`.
    pub(super) fn table_such_as(&self, known: &[&str], example: &str) -> Read<Table<'t>> {
        if !self.is_table() {
            return Err(self.not("a table").help(format!("write for example {example}")));
        }
        self.table(known)
    }

    /// The values of a table that may have any keys.
    pub(super) fn entries(&self) -> Read<impl Iterator<Item = Item<'t>> + use<'t>> {
        let DeValue::Table(entries) = self.value else { return Err(self.not("a table")) };
        Ok(entries.iter().map(|(key, value)| Item::of(key, value)))
    }

    /// The elements of an array of tables, each with a header of its own.
    pub(super) fn tables(&self) -> Read<impl Iterator<Item = Item<'t>> + use<'t>> {
        let name = self.name.clone();
        let DeValue::Array(elements) = self.value else {
            let problem = self.not("a list of tables");
            return Err(problem.help(format!("begin each with the header [[{name}]]")));
        };
        Ok(elements.iter().map(move |element| Item {
            value: element.get_ref(),
            name: name.clone(),
            span: element.span(),
        }))
    }

    /// A string.
    pub(super) fn text(&self) -> Read<&'t str> {
        match self.value {
            DeValue::String(text) => Ok(text),
            _ => Err(self.not("a string")),
        }
    }

    /// `true` or `false`.
    pub(super) fn flag(&self) -> Read<bool> {
        match self.value {
            DeValue::Boolean(flag) => Ok(*flag),
            _ => Err(self.not("true or false")),
        }
    }

    /// The `f32` nearest to the number that is written. It must be finite.
    pub(super) fn number(&self) -> Read<f32> {
        let number = match self.value {
            // Rust reads all forms that TOML allows. Parsed as `f32`, the number is rounded once.
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => nearest_number(integer),
            _ => return Err(self.not("a number")),
        };
        match number {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(self.not_finite()),
        }
    }

    /// The `f32` nearest to the number that is written, and the nearest `f64` to show what the rounding changed.
    pub(super) fn number_and_f64(&self) -> Read<(f32, f64)> {
        let rounded = self.number()?;
        let precise = match self.value {
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        };
        Ok((rounded, precise.unwrap_or(rounded.into())))
    }

    /// A number greater than 0.
    pub(super) fn positive(&self) -> Read<f32> {
        match self.number()? {
            number if number > 0.0 => Ok(number),
            _ => Err(self.problem(format!("is {}; it must be greater than 0", self.written()))),
        }
    }

    /// A number that is at least 0.
    pub(super) fn not_negative(&self) -> Read<f32> {
        match self.number()? {
            number if number >= 0.0 => Ok(number),
            _ => Err(self.problem(format!("is {}; it must be at least 0", self.written()))),
        }
    }

    /// A whole number that is not negative.
    pub(super) fn count(&self) -> Read<u32> {
        let DeValue::Integer(integer) = self.value else {
            return Err(self.not("a whole number"));
        };
        u32::from_str_radix(integer.as_str(), integer.radix()).map_err(|_| {
            let (written, most) = (self.written(), u32::MAX);
            self.problem(format!("is {written}; it must be a whole number from 0 to {most}"))
        })
    }

    /// Two numbers.
    pub(super) fn pair(&self) -> Read<[f32; 2]> {
        let [a, b] = self.elements("two numbers")?;
        Ok([a.number()?, b.number()?])
    }

    /// Two numbers greater than 0.
    pub(super) fn positive_pair(&self) -> Read<[f32; 2]> {
        let [a, b] = self.elements("two numbers")?;
        Ok([a.positive()?, b.positive()?])
    }

    /// Two whole numbers that are not negative.
    pub(super) fn counts(&self) -> Read<[u32; 2]> {
        let [a, b] = self.elements("two whole numbers")?;
        Ok([a.count()?, b.count()?])
    }

    /// Three numbers.
    pub(super) fn vector(&self) -> Read<Vec3> {
        let [x, y, z] = self.elements("three numbers")?;
        Ok(Vec3::new(x.number()?, y.number()?, z.number()?))
    }

    /// Three whole numbers that are not negative.
    pub(super) fn three_counts(&self) -> Read<[u32; 3]> {
        let [a, b, c] = self.elements("three whole numbers")?;
        Ok([a.count()?, b.count()?, c.count()?])
    }

    /// The elements of an array of any length. The message shows `example`.
    pub(super) fn list(&self, example: &str) -> Read<Vec<Item<'t>>> {
        let DeValue::Array(elements) = self.value else {
            return Err(self.not("a list or a table").help(format!("write for example {example}")));
        };
        Ok(numbered(&self.name, elements))
    }

    /// Any number of numbers; `what` says in messages what they must be.
    pub(super) fn numbers(&self, what: &str) -> Read<Vec<f32>> {
        let DeValue::Array(elements) = self.value else { return Err(self.not(what)) };
        numbered(&self.name, elements).iter().map(Item::number).collect()
    }

    /// Tells whether the value is a table.
    pub(super) fn is_table(&self) -> bool {
        matches!(self.value, DeValue::Table(_))
    }

    /// Tells whether the value is one number.
    pub(super) fn is_number(&self) -> bool {
        matches!(self.value, DeValue::Integer(_) | DeValue::Float(_))
    }

    /// Tells whether the value is an array.
    pub(super) fn is_array(&self) -> bool {
        matches!(self.value, DeValue::Array(_))
    }

    /// Three numbers that are not 0.
    pub(super) fn not_zero_triple(&self) -> Read<[f32; 3]> {
        if !self.is_array() {
            return Err(self.not("a number, or three numbers in brackets"));
        }
        let items = self.elements::<3>("three numbers")?;
        for item in &items {
            if item.number()? == 0.0 {
                let what = format!("is {}; it must not be 0, which flattens", item.written());
                return Err(item.problem(what).help("scale by a small number instead"));
            }
        }
        let [x, y, z] = items;
        Ok([x.number()?, y.number()?, z.number()?])
    }

    /// Three numbers that are not all 0.
    pub(super) fn direction(&self) -> Read<Vec3> {
        match self.vector()? {
            Vec3::ZERO => {
                let problem = self.problem("is zero and so has no direction");
                Err(problem.help("give a vector with a length"))
            }
            vector => Ok(vector),
        }
    }

    /// The elements of an array of exactly `N`; `what` says so in messages.
    pub(super) fn elements<const N: usize>(&self, what: &str) -> Read<[Item<'t>; N]> {
        let DeValue::Array(elements) = self.value else { return Err(self.not(what)) };
        let items = numbered(&self.name, elements);
        items.try_into().map_err(|items: Vec<Item>| {
            let count = items.len();
            self.problem(format!("has {count} {}; it must be {what}", plural("element", count)))
        })
    }

    /// The problem that the value has another type.
    fn not(&self, what: &str) -> Problem {
        self.problem(format!("is {}; it must be {what}", kind(self.value)))
    }

    /// The problem that the number is not finite as an `f32`.
    fn not_finite(&self) -> Problem {
        let written = self.written();
        if written.contains("inf") || written.contains("nan") {
            self.problem(format!("is {written}; it must be a finite number"))
        } else {
            self.problem(format!("is {written}; it must be between -3.4e38 and 3.4e38"))
        }
    }

    /// A number as the file writes it, or the type of another value.
    pub(super) fn written(&self) -> String {
        match self.value {
            DeValue::Float(float) => shown(float.as_str()),
            DeValue::Integer(integer) => shown(&integer.to_string()),
            other => kind(other).to_owned(),
        }
    }
}

/// The elements of an array, with their numbers in their names.
fn numbered<'t>(name: &str, elements: &'t DeArray<'t>) -> Vec<Item<'t>> {
    let items = elements.iter().enumerate().map(|(index, element)| Item {
        value: element.get_ref(),
        name: format!("{name}[{index}]"),
        span: element.span(),
    });
    items.collect()
}

/// The nearest `f32` to a whole number of any radix.
fn nearest_number(integer: &DeInteger) -> Option<f32> {
    if integer.radix() == 10 {
        integer.as_str().parse().ok()
    } else {
        i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|number| number as f32)
    }
}

/// The type of a value, in words.
fn kind(value: &DeValue) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a decimal number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}

fn plural(noun: &str, count: usize) -> String {
    if count == 1 { noun.to_owned() } else { format!("{noun}s") }
}
