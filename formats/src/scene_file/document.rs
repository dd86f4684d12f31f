//! Walking a TOML document by hand, so that every error has its place: tables whose keys are
//! checked, and values that turn into what is asked for or say why not.

use super::error::Problem;
use super::suggestion::suggestion;
use crate::source::quote::{quoted, shown};
use glam::Vec3;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};

/// A value of the file, or what is wrong with it.
type Read<T> = Result<T, Problem>;

/// A table all of whose keys are known.
#[derive(Debug)]
pub(super) struct Table<'t> {
    entries: &'t DeTable<'t>,
    /// What messages call it.
    name: String,
    pub(super) span: Range<usize>,
}

/// One value of the document.
#[derive(Clone, Debug)]
pub(super) struct Item<'t> {
    value: &'t DeValue<'t>,
    /// What messages call it: its key, with the element's number behind it.
    pub(super) name: String,
    pub(super) span: Range<usize>,
}

impl<'t> Table<'t> {
    /// A table that may have the known keys and no others.
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

    /// The value of a key that the table must have; `example` shows one that has it.
    pub(super) fn need(&self, key: &str, example: &str) -> Read<Item<'t>> {
        self.get(key).ok_or_else(|| {
            Problem::new(self.span.clone(), format!("{} lacks {key}", shown(&self.name)))
                .help(format!("write for example {example}"))
        })
    }

    /// Where a key stands, to underline it rather than its value; the table itself if it is not
    /// there.
    pub(super) fn span_of(&self, key: &str) -> Range<usize> {
        self.entries.get_key_value(key).map_or(self.span.clone(), |(key, _)| key.span())
    }

    /// Those of the keys that the table has, in the order of the file.
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

    /// Something that is wrong with this value: its name and the rest of the sentence.
    pub(super) fn problem(&self, what: impl std::fmt::Display) -> Problem {
        Problem::new(self.span.clone(), format!("{} {what}", shown(&self.name)))
    }

    /// A table with keys among those known.
    pub(super) fn table(&self, known: &[&str]) -> Read<Table<'t>> {
        let DeValue::Table(entries) = self.value else { return Err(self.not("a table")) };
        Table::new(entries, self.name.clone(), self.span.clone(), known)
    }

    /// A table with any keys: those of the file's own choice.
    pub(super) fn entries(&self) -> Read<impl Iterator<Item = Item<'t>> + use<'t>> {
        let DeValue::Table(entries) = self.value else { return Err(self.not("a table")) };
        Ok(entries.iter().map(|(key, value)| Item::of(key, value)))
    }

    /// An array of tables, each written under a header of its own.
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

    pub(super) fn text(&self) -> Read<&'t str> {
        match self.value {
            DeValue::String(text) => Ok(text),
            _ => Err(self.not("a string")),
        }
    }

    pub(super) fn flag(&self) -> Read<bool> {
        match self.value {
            DeValue::Boolean(flag) => Ok(*flag),
            _ => Err(self.not("true or false")),
        }
    }

    /// The `f32` nearest to the number that is written, which is finite.
    pub(super) fn number(&self) -> Read<f32> {
        let number = match self.value {
            // Both are written so that Rust reads them; straight to f32, so that they round once.
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => nearest_number(integer),
            _ => return Err(self.not("a number")),
        };
        match number {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(self.not_finite()),
        }
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

    /// A whole number.
    pub(super) fn count(&self) -> Read<u32> {
        let DeValue::Integer(integer) = self.value else {
            return Err(self.not("a whole number"));
        };
        u32::from_str_radix(integer.as_str(), integer.radix()).map_err(|_| {
            let (written, most) = (self.written(), u32::MAX);
            self.problem(format!("is {written}; it must be a whole number from 0 to {most}"))
        })
    }

    pub(super) fn pair(&self) -> Read<[f32; 2]> {
        let [a, b] = self.elements("two numbers")?;
        Ok([a.number()?, b.number()?])
    }

    /// Two numbers greater than 0.
    pub(super) fn positive_pair(&self) -> Read<[f32; 2]> {
        let [a, b] = self.elements("two numbers")?;
        Ok([a.positive()?, b.positive()?])
    }

    pub(super) fn counts(&self) -> Read<[u32; 2]> {
        let [a, b] = self.elements("two whole numbers")?;
        Ok([a.count()?, b.count()?])
    }

    pub(super) fn vector(&self) -> Read<Vec3> {
        let [x, y, z] = self.elements("three numbers")?;
        Ok(Vec3::new(x.number()?, y.number()?, z.number()?))
    }

    /// Whether it is one number, of whichever kind.
    pub(super) fn is_number(&self) -> bool {
        matches!(self.value, DeValue::Integer(_) | DeValue::Float(_))
    }

    /// Three numbers, none of them 0.
    pub(super) fn not_zero_triple(&self) -> Read<[f32; 3]> {
        if !matches!(self.value, DeValue::Array(_)) {
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

    /// A vector that has a length.
    pub(super) fn direction(&self) -> Read<Vec3> {
        match self.vector()? {
            Vec3::ZERO => {
                let problem = self.problem("is zero and so has no direction");
                Err(problem.help("give a vector with a length"))
            }
            vector => Ok(vector),
        }
    }

    /// Exactly so many elements.
    fn elements<const N: usize>(&self, what: &str) -> Read<[Item<'t>; N]> {
        let DeValue::Array(elements) = self.value else { return Err(self.not(what)) };
        let items = numbered(&self.name, elements);
        items.try_into().map_err(|items: Vec<Item>| {
            let count = items.len();
            self.problem(format!("has {count} {}; it must be {what}", plural("element", count)))
        })
    }

    fn not(&self, what: &str) -> Problem {
        self.problem(format!("is {}; it must be {what}", kind(self.value)))
    }

    fn not_finite(&self) -> Problem {
        let written = self.written();
        if written.contains("inf") || written.contains("nan") {
            self.problem(format!("is {written}; it must be a finite number"))
        } else {
            self.problem(format!("is {written}; it must be between -3.4e38 and 3.4e38"))
        }
    }

    /// A number as the file has it, or what else it is.
    pub(super) fn written(&self) -> String {
        match self.value {
            DeValue::Float(float) => shown(float.as_str()),
            DeValue::Integer(integer) => shown(&integer.to_string()),
            other => kind(other).to_owned(),
        }
    }
}

fn numbered<'t>(name: &str, elements: &'t DeArray<'t>) -> Vec<Item<'t>> {
    let items = elements.iter().enumerate().map(|(index, element)| Item {
        value: element.get_ref(),
        name: format!("{name}[{index}]"),
        span: element.span(),
    });
    items.collect()
}

fn nearest_number(integer: &DeInteger) -> Option<f32> {
    if integer.radix() == 10 {
        integer.as_str().parse().ok()
    } else {
        i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|number| number as f32)
    }
}

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
