//! How a figure tells the orders apart: each has a colour, and for those who cannot tell the colours apart a mark.

use super::drawing::{Drawing, Ink};
use super::theme::Role;
use crate::orders::Order;

impl From<Order> for Role {
    fn from(order: Order) -> Role {
        match order {
            Order::Object => Role::Object,
            Order::Image => Role::Image,
        }
    }
}

/// Draws the mark of an order around a place: a disc with this radius for object order, a square for image order.
pub(crate) fn mark(drawing: &mut Drawing, order: Order, [x, y]: [f64; 2], radius: f64, ink: Ink) {
    match order {
        Order::Object => drawing.disc([x, y], radius, ink),
        Order::Image => {
            let half = 0.9 * radius;
            drawing.rectangle([x - half, y - half], [2.0 * half; 2], ink);
        }
    }
}
