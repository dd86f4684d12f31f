//! Which loop is the outer one, and how it skips work.

use serde::Serialize;

/// Which loop is the outer one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Order {
    /// For each object, for each pixel: rasterization.
    Object,
    /// For each pixel, for each object: ray tracing.
    Image,
}

impl Order {
    /// The lecture's name for it.
    pub fn name(self) -> &'static str {
        match self {
            Order::Object => "object order",
            Order::Image => "image order",
        }
    }

    /// What everybody else calls it.
    pub fn common_name(self) -> &'static str {
        match self {
            Order::Object => "rasterization",
            Order::Image => "ray tracing",
        }
    }

    /// The lecture's two loops, the outer one first.
    pub fn loops(self) -> [&'static str; 2] {
        match self {
            Order::Object => ["for each object in the scene", "for each pixel it may affect"],
            Order::Image => ["for each pixel in the image", "for each object its ray may hit"],
        }
    }

    /// How its files' names begin or end.
    pub fn file_stem(self) -> &'static str {
        match self {
            Order::Object => "object-order",
            Order::Image => "image-order",
        }
    }
}

/// How an order skips work that cannot matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// With all its machinery.
    #[default]
    Fast,
    /// Not at all: every primitive at every sample.
    Textbook,
}

impl Method {
    /// Its name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Method::Fast => "fast",
            Method::Textbook => "textbook",
        }
    }
}
