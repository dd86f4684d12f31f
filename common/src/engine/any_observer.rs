//! Observers of any type, so that the outer loops of a fast renderer are compiled once, and not anew for each observer.

use crate::observe::{Events, Observer};

/// An observer of any type.
pub trait AnyObserver {
    /// Calls `draw` with an observer for each of so many parts of the picture, and takes back what they have seen, in
    /// the order of the parts.
    fn in_parts(&mut self, count: usize, draw: &mut dyn FnMut(Vec<&mut dyn PartObserver>));
}

/// The observer of one part of the picture.
pub trait PartObserver: Send {
    /// The observer as an event sink, if it watches.
    fn sink(&mut self) -> Option<&mut dyn Events>;
}

impl<O: Observer> AnyObserver for O {
    fn in_parts(&mut self, count: usize, draw: &mut dyn FnMut(Vec<&mut dyn PartObserver>)) {
        let mut parts: Vec<O> = (0..count).map(|_| self.fork()).collect();
        draw(parts.iter_mut().map(|part| part as &mut dyn PartObserver).collect());
        parts.into_iter().for_each(|part| self.join(part));
    }
}

impl<O: Observer> PartObserver for O {
    fn sink(&mut self) -> Option<&mut dyn Events> {
        Observer::sink(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::Sample;

    /// The columns of the rays that were begun.
    #[derive(Default)]
    struct Columns(Vec<usize>);

    impl Events for Columns {
        fn ray_begun(&mut self, sample: Sample) {
            self.0.push(sample.column);
        }
    }

    impl Observer for Columns {
        fn fork(&self) -> Self {
            Columns::default()
        }

        fn join(&mut self, part: Self) {
            self.0.extend(part.0);
        }
    }

    #[test]
    fn parts_are_joined_in_their_order_whoever_draws_first() {
        let mut columns = Columns::default();
        columns.in_parts(3, &mut |mut parts| {
            for column in [2, 0, 1, 0] {
                let sink = parts[column].sink().expect("it watches");
                sink.ray_begun(Sample { row: 0, column });
            }
        });
        assert_eq!(columns.0, [0, 0, 1, 2]);
    }

    #[test]
    fn nobody_watches_for_nothing() {
        let mut parts_drawn = 0;
        ().in_parts(4, &mut |mut parts| {
            parts_drawn += parts.len();
            assert!(parts.iter_mut().all(|part| part.sink().is_none()));
        });
        assert_eq!(parts_drawn, 4);
    }
}
