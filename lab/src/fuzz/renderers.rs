//! The four renderers that the fuzzer compares, and others in their place.

use super::close_calls::CloseCalls;
use crate::common::{Frame, Options, View};
use crate::orders::{Method, Order};
use crate::{rasterize, raytrace};
use std::fmt;

/// A function that finds what is seen at every sample of a frame, and counts close calls where it is asked to.
pub type Draw = dyn Fn(&View, &Options, &mut Frame, Option<&mut CloseCalls>) + Send + Sync;

/// Each order by each method: four renderers.
pub struct Renderers {
    all: [(Order, Method, Box<Draw>); 4],
}

impl Renderers {
    /// The renderers of this program.
    pub fn sound() -> Renderers {
        macro_rules! textbook {
            ($order:ident) => {
                Box::new(|view, options, frame, close| match close {
                    None => $order::textbook::determine_visibility(view, options, frame, &mut ()),
                    Some(close) => {
                        $order::textbook::determine_visibility(view, options, frame, close)
                    }
                })
            };
        }
        macro_rules! fast {
            ($order:ident) => {
                Box::new(|view, options, frame, close| {
                    use $order::fast::{determine_visibility, prepare};
                    let prepared = prepare(view.scene);
                    let _ = match close {
                        None => determine_visibility(&prepared, view, options, frame, &mut ()),
                        Some(close) => determine_visibility(&prepared, view, options, frame, close),
                    };
                })
            };
        }
        Renderers {
            all: [
                (Order::Object, Method::Fast, fast!(rasterize)),
                (Order::Image, Method::Fast, fast!(raytrace)),
                (Order::Object, Method::Textbook, textbook!(rasterize)),
                (Order::Image, Method::Textbook, textbook!(raytrace)),
            ],
        }
    }

    /// The same renderers with another one in the place of one of them, such as one with a fault.
    #[must_use]
    pub fn with(
        mut self,
        order: Order,
        method: Method,
        draw: impl Fn(&View, &Options, &mut Frame, Option<&mut CloseCalls>) + Send + Sync + 'static,
    ) -> Renderers {
        for (own_order, own_method, own) in &mut self.all {
            if (*own_order, *own_method) == (order, method) {
                *own = Box::new(draw);
                break;
            }
        }
        self
    }

    /// The renderer of an order and a method.
    pub fn of(&self, order: Order, method: Method) -> &Draw {
        let found = self.all.iter().find(|(own, by, _)| (*own, *by) == (order, method));
        &*found.expect("there is one for each order and method").2
    }
}

impl fmt::Debug for Renderers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.all.iter().map(|(order, method, _)| (order, method));
        f.debug_list().entries(names).finish()
    }
}
