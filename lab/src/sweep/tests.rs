use super::*;
use crate::figure::{Theme, sweep_chart};
use crate::orders::{Method, Order};

/// A plan whose counts take a moment.
const SMALL: Plan = Plan { image: [96, 54], most: 40_000, times: false, rounds: 1 };

fn counted(axes: &[Axis]) -> Table {
    let mut bench = Bench::default();
    let mut table = Table::default();
    for task in SMALL.tasks(axes) {
        // A picture of millions of pixels is no task for a test.
        if task.case.samples() <= 60_000 {
            table.insert(task, bench.measure(&task));
        }
    }
    table
}

fn slope_of(summary: &Summary, order: Order, method: Method) -> f64 {
    let is = |curve: &&Curve| (curve.order, curve.method) == (order, method);
    summary.curves.iter().find(is).unwrap().slope.unwrap().value
}

/// The slopes of the counts: object order and image order, fast; then both textbooks.
fn slopes(axis: Axis) -> [f64; 4] {
    let summary = Summary::of(&counted(&[axis]), axis, Quantity::Steps).unwrap();
    let of = |method| Order::ALL.map(|order| slope_of(&summary, order, method));
    let ([a, b], [c, d]) = (of(Method::Fast), of(Method::Textbook));
    [a, b, c, d]
}

#[test]
fn counts_grow_with_triangles_as_the_loops_say() {
    let [object_order, image_order, textbooks @ ..] = slopes(Axis::Triangles);
    assert!(textbooks.iter().all(|slope| (slope - 1.0).abs() < 0.01), "{textbooks:?}");
    assert!((0.3..1.1).contains(&object_order), "{object_order}");
    assert!(image_order < 0.35, "a hierarchy passes over nearly all: {image_order}");
}

#[test]
fn counts_grow_linearly_with_pixels() {
    let [object_order, image_order, textbooks @ ..] = slopes(Axis::Pixels);
    assert!(textbooks.iter().all(|slope| (slope - 1.0).abs() < 0.01), "{textbooks:?}");
    assert!((0.6..1.05).contains(&object_order), "{object_order}");
    assert!((0.9..1.05).contains(&image_order), "{image_order}");
}

#[test]
fn hidden_layers_cost_image_order_little() {
    let [object_order, image_order, textbooks @ ..] = slopes(Axis::DepthComplexity);
    assert!(textbooks.iter().all(|slope| (slope - 1.0).abs() < 0.02), "{textbooks:?}");
    assert!((object_order - 1.0).abs() < 0.1, "every layer is tested: {object_order}");
    assert!(image_order < 0.5, "{image_order}");
}

#[test]
fn larger_triangles_are_fewer() {
    let [_, image_order, textbook, other] = slopes(Axis::TriangleSize);
    assert!((textbook + 1.0).abs() < 0.01, "{textbook}");
    // Where two triangles fill the picture, the rays of the outer loop are a third of the steps.
    assert!((-1.0..-0.85).contains(&other), "{other}");
    assert!((-0.5..0.0).contains(&image_order), "{image_order}");
}

#[test]
fn more_instances_cost_image_order_little() {
    let [object_order, image_order, textbooks @ ..] = slopes(Axis::Instances);
    assert!(textbooks.iter().all(|slope| (slope - 1.0).abs() < 0.01), "{textbooks:?}");
    assert!((object_order - 1.0).abs() < 0.2, "every triangle of every instance: {object_order}");
    assert!(image_order < 0.4, "{image_order}");
}

#[test]
fn what_holds_by_definition_is_what_a_run_counts() {
    let plan = Plan { image: [48, 30], most: 1000, ..SMALL };
    let mut bench = Bench::default();
    for task in plan.tasks(&[Axis::Triangles, Axis::DepthComplexity]) {
        if task.method == Method::Textbook {
            let counted = bench.measure(&task);
            assert_eq!(counted.source, Source::Counted);
            let outer = match task.order {
                Order::Object => task.case.triangles,
                Order::Image => task.case.samples(),
            };
            assert_eq!(counted.value, (outer + task.case.triangles * task.case.samples()) as f64);
        }
    }
    let large = Plan { image: [640, 360], ..plan };
    let textbook = large
        .tasks(&[Axis::Triangles])
        .into_iter()
        .find(|task| task.method == Method::Textbook && task.case.triangles == 100);
    let known = bench.measure(&textbook.unwrap());
    assert_eq!(known, Measured { value: 23_040_100.0, source: Source::ByDefinition });
}

#[test]
fn a_table_is_read_back_and_says_why_it_is_refused() {
    let mut table = Table::new("1 thread, here");
    let plan = Plan { times: true, rounds: 2, most: 1000, ..SMALL };
    for (number, task) in (1..).zip(plan.tasks(&[Axis::Triangles])) {
        let (value, source) = match task.quantity {
            Quantity::Steps => (f64::from(number), Source::Counted),
            Quantity::Milliseconds => (f64::from(number) * 0.25, Source::Measured),
        };
        table.insert(task, Measured { value, source });
    }
    let text = table.csv();
    let read = |text: &str, plan: &Plan, conditions| {
        Table::read(text, plan, conditions).map_err(|error| error.to_string())
    };
    let back = read(&text, &plan, "1 thread, here").unwrap();
    assert_eq!(back.csv(), text);
    assert!(plan.tasks(&[Axis::Triangles]).iter().all(|task| back.has(task)));
    assert!(!back.has(&plan.tasks(&[Axis::Pixels])[0]));

    let other = read(&text, &plan, "2 threads").unwrap_err();
    assert_eq!(other, "it has times of \"1 thread  here\", and this run is \"2 threads\"");
    let none = read(&text, &plan, "").unwrap_err();
    assert_eq!(none, "it has times of \"1 thread  here\", and this run takes none");
    let resized = read(&text, &Plan { image: [97, 54], ..plan }, "1 thread, here").unwrap_err();
    let said = "it has 100 triangles in 96x54 pixels along triangles, which is no scene of a sweep with this --size";
    assert_eq!(resized, said);
    for (damaged, said) in [
        ("", "line 1 is not what a sweep writes (its columns are others)"),
        ("x,y\n1,2\n", "line 1 is not what a sweep writes (its columns are others)"),
        (&text[..text.len() - 40], "line 31 is not"),
        (&text.replacen("counted", "guessed", 1), "line 2 is not what a sweep writes (its value"),
        (&text.replacen(",1,counted", ",-1,counted", 1), "line 2 is not what a sweep writes (its"),
    ] {
        let problem = read(damaged, &plan, "1 thread, here").unwrap_err();
        assert!(problem.starts_with(said), "{problem}");
    }
}

/// Points with these values, at 1, 2, 4 and so on, whose repetitions are 4 % apart.
fn points(values: &[f64]) -> Vec<Point> {
    let point = |(power, &value): (i32, &f64)| Point {
        x: 2_f64.powi(power),
        value,
        least: value,
        most: 1.04 * value,
        source: Source::Measured,
    };
    (0..).zip(values).map(point).collect()
}

#[test]
fn a_slope_is_that_of_the_upper_part() {
    let slope = fit::slope(&points(&[50.0, 50.0, 50.0, 8.0, 16.0, 32.0, 64.0])).unwrap();
    assert_eq!((slope.from, slope.points), (8.0, 4));
    assert!((slope.value - 1.0).abs() < 1e-12 && slope.error < 1e-6);
    let bent = fit::slope(&points(&[1.0, 1.0, 1.0, 8.0])).unwrap();
    assert!(bent.error > 0.5, "{bent:?}");
    assert_eq!(fit::slope(&points(&[1.0, 2.0])), None);
}

#[test]
fn a_crossing_is_named_only_where_it_is_seen() {
    let crossing = |a: &[f64], b: &[f64]| fit::crossing(&points(a), &points(b), 1.1);
    let Crossing::At { x, value, first, sharp } =
        crossing(&[1.0, 2.0, 4.0, 8.0], &[4.0, 4.0, 4.0, 4.0])
    else {
        panic!("they cross");
    };
    assert!((x - 4.0).abs() < 1e-9 && (value - 4.0).abs() < 1e-9 && !first && !sharp);
    let none = crossing(&[1.0, 2.0, 4.0], &[4.0, 4.0, 8.0]);
    assert_eq!(none, Crossing::None { first: true, by: [2.0, 4.0], everywhere: true });
    // A difference of a hundredth is none.
    assert_eq!(crossing(&[1.0, 2.0], &[1.01, 1.99]), Crossing::Alike);
    let several = crossing(&[1.0, 4.0, 1.0, 4.0], &[2.0, 2.0, 2.0, 2.0]);
    assert_eq!(several, Crossing::Several { from: 1.0, to: 8.0, times: 3 });
    assert_eq!(crossing(&[1.0], &[2.0]), Crossing::Unknown);
    // Where the repetitions of two points overlap, they tell nothing.
    let (mut noisy, steady) = (points(&[1.0, 1.0, 3.0]), points(&[2.0, 2.0, 2.0]));
    noisy[2].least = 1.9;
    noisy[2].most = 9.0;
    let seen = fit::crossing(&noisy, &steady, 1.1);
    assert!(matches!(seen, Crossing::None { first: true, everywhere: false, .. }), "{seen:?}");
}

#[test]
fn sentences_say_no_more_than_is_seen() {
    let summary = |quantity, fast| Summary {
        axis: Axis::Triangles,
        quantity,
        curves: Vec::new(),
        fast,
        textbook: Crossing::Alike,
    };
    let at = |sharp| Crossing::At { x: 12_345.0, value: 1.0, first: false, sharp };
    for (quantity, fast, said) in [
        (Quantity::Steps, at(true), "from about 12 k triangles on, image order takes fewer steps"),
        (
            Quantity::Milliseconds,
            at(false),
            "from somewhere near 12 k triangles on, image order is faster",
        ),
        (
            Quantity::Milliseconds,
            Crossing::Several { from: 1000.0, to: 31_684.0, times: 3 },
            "the curves cross 3 times between 1 k and 32 k triangles: too close to tell there",
        ),
        (
            Quantity::Milliseconds,
            Crossing::None { first: true, by: [1.2, 31.0], everywhere: true },
            "no crossing in this range: image order takes 1.2 to 31 times as long",
        ),
        (
            Quantity::Milliseconds,
            Crossing::None { first: false, by: [1.15, 4.8], everywhere: false },
            "where the orders can be told apart: object order takes 1.1 to 4.8 times as long",
        ),
        (
            Quantity::Milliseconds,
            Crossing::Alike,
            "too close to tell which order is faster, anywhere in this range",
        ),
    ] {
        assert_eq!(summary(quantity, fast).says(Method::Fast), said);
    }
    let textbook = summary(Quantity::Steps, Crossing::Alike).says(Method::Textbook);
    assert_eq!(textbook, "both orders take the same number of steps, to 2 %");
}

#[test]
fn the_texts_of_charts_do_not_overlap() {
    let table = counted(&Axis::ALL);
    for axis in Axis::ALL {
        let steps = Summary::of(&table, axis, Quantity::Steps).unwrap();
        assert_eq!(Summary::of(&table, axis, Quantity::Milliseconds), None);
        // Times with an early end of the textbooks, and two curves that nearly coincide.
        let mut times = Summary { quantity: Quantity::Milliseconds, ..steps.clone() };
        for curve in &mut times.curves {
            let points = curve.points.len();
            curve.points.truncate(if curve.method == Method::Textbook { 3 } else { points });
            for point in &mut curve.points {
                point.value /= 1e6;
                (point.least, point.most) = (point.value, 1.3 * point.value);
            }
        }
        times.fast =
            Crossing::At { x: steps.curves[0].points[2].x, value: 0.1, first: true, sharp: true };
        for summary in [&steps, &times] {
            for theme in [Theme::Dark, Theme::Light] {
                let drawing =
                    sweep_chart(summary, "1 thread of 2 · a processor", SMALL.image, theme);
                assert_eq!(
                    drawing.faults(),
                    Vec::<String>::new(),
                    "{axis:?} {:?}",
                    summary.quantity
                );
                assert_eq!(
                    drawing.svg(),
                    sweep_chart(summary, "1 thread of 2 · a processor", SMALL.image, theme).svg()
                );
            }
        }
    }
}
