//! How a figure tells the orders apart (each has a colour, and for those who cannot tell the colours apart a mark), and how it
//! marks a pixel.

use super::drawing::{Drawing, Ink, Pen};
use super::theme::{Role, Theme};
use crate::orders::Order;

impl From<Order> for Role {
    fn from(order: Order) -> Role {
        match order {
            Order::Object => Role::Object,
            Order::Image => Role::Image,
        }
    }
}

/// Marks the pixel that is looked at, around its middle.
pub(crate) fn crosshair(drawing: &mut Drawing, [x, y]: [f64; 2], theme: Theme) {
    for (pen, reach) in
        [(Pen::new(theme.background(), 7.0), 31.0), (Pen::new(theme.of(Role::Focus), 3.5), 30.0)]
    {
        drawing.ring([x, y], 14.0, pen);
        for [across, down] in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
            let from = [x + 14.0 * across, y + 14.0 * down];
            drawing.line(&[from, [x + reach * across, y + reach * down]], pen);
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
