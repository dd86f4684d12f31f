//! The door to JavaScript. `worker.js` is its only user.

use crate::{Answer, Buffer, Engine};
use std::sync::Mutex;
use wasm_bindgen::Clamped;
use wasm_bindgen::prelude::*;

/// What the module said when it broke: a bug, which the worker shows before it starts the module anew.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// The engine, for the worker.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Module {
    engine: Engine,
}

/// An answer, for the worker.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Reply(Answer);

#[wasm_bindgen]
impl Module {
    /// An engine without a scene.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Module {
        std::panic::set_hook(Box::new(|info| {
            if let Ok(mut text) = PANIC.lock() {
                *text = info.to_string();
            }
        }));
        Module::default()
    }

    /// Answers a message: [`Engine::call`].
    ///
    /// # Errors
    ///
    /// A text for the reader of the page.
    pub fn call(
        &mut self,
        name: &str,
        arguments: &str,
        bytes: Option<Box<[u8]>>,
    ) -> Result<Reply, String> {
        self.engine.call(name, arguments, bytes.as_deref()).map(Reply)
    }
}

/// What the module said when it broke.
#[expect(unreachable_pub, reason = "JavaScript reaches it")]
#[wasm_bindgen(js_name = panicText)]
pub fn panic_text() -> String {
    PANIC.lock().map(|text| text.clone()).unwrap_or_default()
}

#[wasm_bindgen]
impl Reply {
    /// The JSON text.
    pub fn json(&self) -> String {
        self.0.text().to_owned()
    }

    /// The number of buffers.
    pub fn buffers(&self) -> usize {
        self.0.buffers().len()
    }

    /// The path of a buffer in the JSON.
    pub fn path(&self, index: usize) -> String {
        self.0.buffers()[index].0.clone()
    }

    /// The name of the method below that hands a buffer over.
    pub fn kind(&self, index: usize) -> String {
        let name = match &self.0.buffers()[index].1 {
            Buffer::U8(_) => "u8",
            Buffer::U32(_) => "u32",
            Buffer::F32(_) => "f32",
            Buffer::F64(_) => "f64",
        };
        name.into()
    }
}

/// A method for each kind of buffer. Each gives the numbers away: a second call gets none.
#[wasm_bindgen]
impl Reply {
    /// Takes the bytes of a picture, as a `Uint8ClampedArray`.
    pub fn u8(&mut self, index: usize) -> Clamped<Vec<u8>> {
        match self.0.buffer_mut(index) {
            Buffer::U8(bytes) => Clamped(std::mem::take(bytes)),
            _ => Clamped(Vec::new()),
        }
    }

    /// Takes the numbers of a `Uint32Array`.
    pub fn u32(&mut self, index: usize) -> Vec<u32> {
        match self.0.buffer_mut(index) {
            Buffer::U32(numbers) => std::mem::take(numbers),
            _ => Vec::new(),
        }
    }

    /// Takes the numbers of a `Float32Array`.
    pub fn f32(&mut self, index: usize) -> Vec<f32> {
        match self.0.buffer_mut(index) {
            Buffer::F32(numbers) => std::mem::take(numbers),
            _ => Vec::new(),
        }
    }

    /// Takes the numbers of a `Float64Array`.
    pub fn f64(&mut self, index: usize) -> Vec<f64> {
        match self.0.buffer_mut(index) {
            Buffer::F64(numbers) => std::mem::take(numbers),
            _ => Vec::new(),
        }
    }
}
