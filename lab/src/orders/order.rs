//! The two orders, by their outer loop, and the two methods, by the work that they skip.

use serde::Serialize;

/// The order, named after its outer loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Order {
    /// For each object, for each pixel: rasterization.
    Object,
    /// For each pixel, for each object: ray tracing.
    Image,
}

impl Order {
    /// Both orders, in the order of the lecture.
    pub const ALL: [Order; 2] = [Order::Object, Order::Image];

    /// The lecture's name for the order.
    pub fn name(self) -> &'static str {
        match self {
            Order::Object => "object order",
            Order::Image => "image order",
        }
    }

    /// The usual name for the order.
    pub fn common_name(self) -> &'static str {
        match self {
            Order::Object => "rasterization",
            Order::Image => "ray tracing",
        }
    }

    /// The lecture's two loops, the outer loop first.
    pub fn loops(self) -> [&'static str; 2] {
        match self {
            Order::Object => ["for each object in the scene", "for each pixel it may affect"],
            Order::Image => ["for each pixel in the image", "for each object its ray may hit"],
        }
    }

    /// The beginning or the end of the names of the order's files.
    pub fn file_stem(self) -> &'static str {
        match self {
            Order::Object => "object-order",
            Order::Image => "image-order",
        }
    }
}

/// The method of skipping work that cannot affect the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// The method with bounds and hierarchies.
    #[default]
    Fast,
    /// The method that skips nothing: every primitive at every sample.
    Textbook,
}

impl Method {
    /// The name of the method on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Method::Fast => "fast",
            Method::Textbook => "textbook",
        }
    }
}
