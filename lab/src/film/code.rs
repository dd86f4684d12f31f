//! The words of a film: the pseudocode of each order, and its loop variables.

use super::recorded::Film;
use super::recorder::{Line, Position};
use super::shots::{OrderShot, Shot};
use crate::common::View;
use crate::figure::{CodeLine, FilmHalf, FilmPage};
use crate::orders::{Method, Order};
use crate::wording::{count, grouped};

/// The page of a frame.
pub(super) fn page<'a>(film: &'a Film, shot: &'a Shot) -> FilmPage<'a> {
    let [object_order, image_order] = &shot.orders;
    let pixels = u64::from(object_order.picture.width()) * u64::from(object_order.picture.height());
    let longest = film.steps().into_iter().max().unwrap_or(0);
    let done = shot.orders.iter().all(|order| order.done);
    FilmPage {
        scene: &film.scene,
        facts: facts(film, pixels),
        halves: [half(film, Order::Object, object_order), half(film, Order::Image, image_order)],
        clock: shot.clock,
        whole: longest,
        pixels,
        finished: &film.finished[..shot.frame as usize],
        frames: film.length().frames(),
        verdict: done.then(|| film.comparison.verdict()),
        matches: film.comparison.matches(),
    }
}

fn facts(film: &Film, pixels: u64) -> String {
    let objects = count(film.view.scene.primitive_count(), "objects");
    let how = match film.method {
        Method::Textbook => "one step: one pair is tested",
        Method::Fast => "one step: one pair or one box is tested",
    };
    format!(
        "{objects} × {}   ·   {how}   ·   method {}",
        count(pixels, "pixels"),
        film.method.name()
    )
}

fn half<'a>(film: &Film, order: Order, shot: &'a OrderShot) -> FilmHalf<'a> {
    let Position { line, sample, .. } = shot.position;
    let variables = variables(film, order, shot);
    let lines = code(order, film.method).into_iter().zip(variables).enumerate();
    FilmHalf {
        order,
        picture: &shot.picture,
        fresh: if shot.done { &[] } else { &shot.fresh },
        cursor: sample.map(|sample| [sample.row, sample.column]),
        // The last line closes all.
        lines: lines
            .map(|(number, (code, variable))| CodeLine { code, indent: number % 4, variable })
            .collect(),
        lit: line as usize,
        finished: shot.finished,
    }
}

/// The lecture's loops, a line for each [`Line`].
pub(super) fn code(order: Order, method: Method) -> [&'static str; 5] {
    let inner = match (order, method) {
        (Order::Object, Method::Textbook) => "for each pixel in the image {",
        (Order::Object, Method::Fast) => "for each pixel it may affect {",
        (Order::Image, Method::Textbook) => "for each object in the scene {",
        (Order::Image, Method::Fast) => "for each object its ray may hit {",
    };
    let outer = match order {
        Order::Object => "for each object in the scene {",
        Order::Image => "for each pixel in the image {",
    };
    [outer, inner, "if (object affects pixel) {", "keep the nearest", "} } }"]
}

/// The values of the variables in each line of the code.
fn variables(film: &Film, order: Order, shot: &OrderShot) -> [String; 5] {
    let Position { line, primitive, sample, node, kept } = shot.position;
    let object = primitive.map_or(String::new(), |id| object(&film.view, id));
    let object = node.map_or(object, |(node, is_hit)| {
        format!("box {}: {}", grouped(node.into()), if is_hit { "hit" } else { "missed" })
    });
    let pixel = sample.map_or(String::new(), |at| format!("pixel ({}, {})", at.row, at.column));
    let [outer, inner] = match order {
        Order::Object => [object, pixel],
        Order::Image => [pixel, object],
    };
    let affects = match (line, film.method) {
        (Line::Keep, _) => "yes",
        // The fast renderers test some pairs at once, and tell the results together.
        (Line::Test, Method::Textbook) => "no",
        _ => "",
    };
    let keep = match kept {
        Some(id) if line == Line::Keep => format!("object {}", grouped(id.into())),
        _ => String::new(),
    };
    let end = if shot.done {
        format!("done after {}", count(shot.steps, "steps"))
    } else {
        String::new()
    };
    [outer, inner, affects.into(), keep, end]
}

/// A primitive in words.
fn object(view: &View, id: u32) -> String {
    format!("object {}: {}", grouped(id.into()), view.primitive(id.into()).kind())
}
