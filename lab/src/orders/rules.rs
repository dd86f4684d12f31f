//! The rules by which an order decides, beside the exact ones, and a scene that shows each of them.

use super::order::Order;
use crate::rules::{About, image_order, object_order};
use serde::{Serialize, Serializer};
use std::fmt;

/// The rules of both orders; `None` is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rules {
    /// For object order.
    pub object_order: Option<object_order::Rule>,
    /// For image order.
    pub image_order: Option<image_order::Rule>,
}

/// A rule of an ordinary renderer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Of an ordinary rasterizer.
    Object(object_order::Rule),
    /// Of an ordinary ray tracer.
    Image(image_order::Rule),
}

impl Rules {
    /// The rule of one order; `None` is exact.
    pub fn of(&self, order: Order) -> Option<Rule> {
        match order {
            Order::Object => self.object_order.map(Rule::Object),
            Order::Image => self.image_order.map(Rule::Image),
        }
    }
}

impl From<Rule> for Rules {
    /// This rule, and the other order exact.
    fn from(rule: Rule) -> Rules {
        match rule {
            Rule::Object(rule) => Rules { object_order: Some(rule), ..Rules::default() },
            Rule::Image(rule) => Rules { image_order: Some(rule), ..Rules::default() },
        }
    }
}

impl Rule {
    /// The order that it belongs to.
    pub fn order(self) -> Order {
        match self {
            Rule::Object(_) => Order::Object,
            Rule::Image(_) => Order::Image,
        }
    }

    /// What it is, for readers.
    pub fn about(self) -> &'static About {
        match self {
            Rule::Object(rule) => rule.about(),
            Rule::Image(rule) => rule.about(),
        }
    }

    /// The option of the command line that sets it.
    pub fn option(self) -> &'static str {
        match self {
            Rule::Object(_) => "--object-rules",
            Rule::Image(_) => "--image-rules",
        }
    }

    /// The name of a built-in scene in which it differs from the exact rules.
    pub fn scene(self) -> &'static str {
        use image_order::Rule as Image;
        use object_order::Rule as Object;
        match self {
            Rule::Object(rule) => match rule {
                Object::Float32 | Object::Snapped { .. } => "slivers",
                Object::Inclusive | Object::Exclusive => "ties",
                Object::Corner => "canonical",
                Object::NearClip { .. } => "behind",
                Object::Depth24 => "overlap",
            },
            Rule::Image(rule) => match rule {
                Image::MollerTrumbore | Image::Watertight => "ties",
                Image::Float32 => "slivers",
                Image::Corner | Image::FlipRows | Image::Jittered { .. } => "canonical",
                Image::OneOrigin => "parallel",
            },
        }
    }

    /// One rule of each kind, with the number of the examples; object order first.
    pub fn examples() -> Vec<Rule> {
        use image_order::Rule as Image;
        use object_order::Rule as Object;
        let object_order = [
            Object::Float32,
            Object::Inclusive,
            Object::Exclusive,
            Object::Snapped { bits: 8 },
            Object::Corner,
            Object::NearClip { depth: 0.5 },
            Object::Depth24,
        ];
        let image_order = [
            Image::MollerTrumbore,
            Image::Watertight,
            Image::Float32,
            Image::Corner,
            Image::OneOrigin,
            Image::FlipRows,
            Image::Jittered { seed: 7 },
        ];
        let object_order = object_order.into_iter().map(Rule::Object);
        object_order.chain(image_order.into_iter().map(Rule::Image)).collect()
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rule::Object(rule) => rule.fmt(f),
            Rule::Image(rule) => rule.fmt(f),
        }
    }
}

impl Serialize for Rule {
    /// As it is written on the command line.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_are_all_rules() {
        let forms: Vec<_> = Rule::examples().iter().map(|rule| rule.about().form).collect();
        let all = object_order::ALL.iter().chain(image_order::ALL).map(|about| about.form);
        assert!(all.eq(forms));
    }
}
