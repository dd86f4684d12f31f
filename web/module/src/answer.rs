//! What a message is answered with: JSON, and buffers of numbers beside it.

use serde::Serialize;
use serde_json::Value;

/// Numbers that the page gets as a typed array.
#[derive(Clone, Debug, PartialEq)]
pub enum Buffer {
    /// A `Uint8ClampedArray`: what pictures are made of.
    U8(Vec<u8>),
    /// A `Uint32Array`.
    U32(Vec<u32>),
    /// A `Float32Array`.
    F32(Vec<f32>),
    /// A `Float64Array`.
    F64(Vec<f64>),
}

/// The answer to a message.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The text: an `f32` has the fewest digits that read back as the same `f32`, which a [`Value`] does not keep.
    json: String,
    buffers: Vec<(String, Buffer)>,
}

impl Answer {
    /// An answer without buffers.
    ///
    /// # Panics
    ///
    /// If the value has no form in JSON; those of this crate have one.
    pub(crate) fn new(value: impl Serialize) -> Answer {
        let json = serde_json::to_string(&value).expect("plain structures become JSON");
        Answer { json, buffers: Vec::new() }
    }

    /// The same answer with a buffer at a path: `object.ids` is the entry `ids` of the entry `object`.
    pub(crate) fn with(mut self, path: impl Into<String>, buffer: Buffer) -> Answer {
        self.buffers.push((path.into(), buffer));
        self
    }

    /// The JSON text, without the buffers.
    pub fn text(&self) -> &str {
        &self.json
    }

    /// The same, read.
    ///
    /// # Panics
    ///
    /// Never: what was written can be read.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.json).expect("it was written as JSON")
    }

    /// The buffers, each with its path in the JSON.
    pub fn buffers(&self) -> &[(String, Buffer)] {
        &self.buffers
    }

    /// A buffer, by its number, to take its content.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn buffer_mut(&mut self, index: usize) -> &mut Buffer {
        &mut self.buffers[index].1
    }

    /// The buffer at a path.
    pub fn buffer(&self, path: &str) -> Option<&Buffer> {
        self.buffers.iter().find(|(at, _)| at == path).map(|(_, buffer)| buffer)
    }
}

/// A number for `json!`, with the fewest digits that read back as the same `f32`.
pub(crate) fn short(number: f32) -> f64 {
    number.to_string().parse().expect("a number is written as a number")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_few_digits() {
        assert_eq!(Answer::new([0.1_f32, 6.8]).text(), "[0.1,6.8]");
        assert_eq!(short(0.1).to_string(), "0.1");
    }
}
