//! What a message is answered with: JSON, and buffers of numbers beside it.

use serde::Serialize;
use serde_json::{Map, Value};

/// Numbers that the page gets as a typed array.
#[derive(Clone, Debug, PartialEq)]
pub enum Buffer {
    /// A `Uint8ClampedArray`: what pictures are made of.
    U8(Vec<u8>),
    /// A `Uint16Array`.
    U16(Vec<u16>),
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
    json: Value,
    buffers: Vec<(String, Buffer)>,
}

impl Answer {
    /// An answer without buffers.
    ///
    /// # Panics
    ///
    /// If the value has no form in JSON; those of this crate have one.
    pub(crate) fn new(value: impl Serialize) -> Answer {
        let json = serde_json::to_value(value).expect("plain structures become JSON");
        Answer { json, buffers: Vec::new() }
    }

    /// The same answer with a buffer at a path: `object.ids` is the entry `ids` of the entry `object`.
    pub(crate) fn with(mut self, path: impl Into<String>, buffer: Buffer) -> Answer {
        self.buffers.push((path.into(), buffer));
        self
    }

    /// The JSON, without the buffers.
    pub fn json(&self) -> &Value {
        &self.json
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

/// An entry of a map, from a value that has a form in JSON.
pub(crate) fn entry(map: &mut Map<String, Value>, key: &str, value: impl Serialize) {
    map.insert(key.into(), serde_json::to_value(value).expect("plain structures become JSON"));
}
