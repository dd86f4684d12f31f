//! The WebAssembly module of the lecture page: it answers the page's messages with the crates that the program is made of.
//!
//! A message has a name, arguments in JSON, and for some the bytes of files. [`Engine::call`] answers it with JSON and with buffers
//! of numbers, which go to the page as typed arrays; or with a text that says what is wrong, as the command line says it.
//! Nothing here renders, tests or counts by itself: what the page shows comes from the loops that the program runs.
//!
//! ```
//! let mut engine = bothways_web_module::Engine::default();
//! let opened = engine.call("open", r#"{"name": "ties"}"#, None)?;
//! assert_eq!(opened.json()["name"], "ties");
//!
//! let problem = engine.call("open", r#"{"name": "tis"}"#, None).unwrap_err();
//! assert!(problem.starts_with("there is no built-in scene \"tis\"; did you mean \"ties\"?"));
//! # Ok::<(), String>(())
//! ```
//!
//! | file | what is in it |
//! |---|---|
//! | `engine.rs` | the open scene, and the list of messages |
//! | `answer.rs` | JSON and buffers |
//! | `camera.rs` | the camera in the words of scene files |
//! | `stage.rs` | a scene with what both orders prepared of it, and their frames |
//! | `messages/` | a file for each message, or for a few that belong together |
//! | `bindings.rs` | the door to JavaScript; the only file that WebAssembly alone compiles |

mod answer;
#[cfg(target_arch = "wasm32")]
mod bindings;
mod camera;
mod clock;
mod engine;
mod messages;
mod observer;
mod progress;
mod stage;

pub use answer::{Answer, Buffer};
pub use engine::Engine;
