//! How far a long message is, told while it is answered.

/// Tells the worker how many of all steps are done.
#[cfg(target_arch = "wasm32")]
pub(crate) fn tell(done: u32, of: u32) {
    use wasm_bindgen::prelude::wasm_bindgen;

    #[wasm_bindgen]
    extern "C" {
        #[wasm_bindgen(js_name = tellProgress)]
        fn tell_progress(done: u32, of: u32);
    }
    tell_progress(done, of);
}

/// Nobody waits.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn tell(_done: u32, _of: u32) {}
