//! Two flat primitives compared once for all rays of a camera.
//!
//! Where faces lie in one plane, or almost, every sample is a close call. Asking exact arithmetic for
//! each costs a microsecond; but which of two planes is nearer depends on the ray through one linear
//! function alone, whose coefficients can be found exactly once.

use super::dyadic::Dyadic;
use super::judge::Judge;
use super::nearest::{Comparison, Crossing, are_identical, by_rounded_arithmetic, ordering};
use super::real::Real;
use super::sign::Sign;
use crate::camera::{Projection, Ray};
use crate::engine::roundoff::EPS53;
use crate::scene::primitive::Primitive;
use glam::DVec3;
use std::collections::HashMap;

/// Which of two flat primitives is nearer, as a function of the ray.
///
/// With `tᵢ = pᵢ/qᵢ` the sign of `t₁ − t₂` is that of `(p₁·q₂ − p₂·q₁)·q₁·q₂`. For a perspective camera
/// `pᵢ = nᵢ·aᵢ` is the same for all rays and `qᵢ` has its sign wherever the primitive is seen, so that
/// the first factor is `G·D` with `G = p₁·n₂ − p₂·n₁`. For a parallel camera `qᵢ` is the same for all
/// rays and `pᵢ = nᵢ·aᵢ − nᵢ·O`, so that it is `K − G·O` with `G = q₂·n₁ − q₁·n₂` and `K = (n₁·a₁)·q₂ −
/// (n₂·a₂)·q₁`.
#[derive(Clone, Copy, Debug)]
enum Pair {
    /// The function is zero everywhere: nothing but the order in the scene tells them apart.
    SamePlane,
    Function {
        /// `K`, rounded.
        constant: f64,
        /// `G`, or `−G` for a parallel camera, rounded.
        slope: DVec3,
        /// The sign of `q₁·q₂`.
        side: Sign,
    },
}

impl Pair {
    fn new(judge: &Judge, first: &Primitive, second: &Primitive) -> Option<Pair> {
        // From the eye itself, along the view.
        let axis = Ray { origin: DVec3::ZERO, direction: judge.forward };
        let crossing = |flat| Crossing::<Dyadic>::new(flat, &axis);
        let (first, second) = (crossing(first), crossing(second));
        let (weights, constant) = match judge.projection {
            Projection::Perspective => ([&first.p, &second.p], None),
            Projection::Parallel => {
                let constant = first.p.times(&second.q).minus(&second.p.times(&first.q));
                ([&first.q, &second.q], Some(constant))
            }
        };
        let slope: [Dyadic; 3] = std::array::from_fn(|k| {
            weights[0].times(&second.normal[k]).minus(&weights[1].times(&first.normal[k]))
        });
        let side = weights[0].sign()? * weights[1].sign()?;
        let is_zero = |number: &Dyadic| number.sign() == Some(Sign::Zero);
        Some(if slope.iter().chain(&constant).all(is_zero) {
            Pair::SamePlane
        } else {
            Pair::Function {
                constant: constant.map_or(0.0, |constant| constant.to_f64()),
                slope: DVec3::from(slope.map(|number| number.to_f64())),
                side,
            }
        })
    }

    /// The comparison along a ray that meets both, if rounding leaves no doubt.
    ///
    /// `constant` and `slope` carry one rounding each, a product one, and the sums of four terms at
    /// most 3. The bound takes 8. It has no floor: nothing underflows in the accepted range, products
    /// of two coefficients and a direction being zero or far above 2⁻¹⁰²².
    fn compare(&self, projection: Projection, ray: &Ray) -> Option<Comparison> {
        let Pair::Function { constant, slope, side } = *self else {
            return Some(Comparison::EQUAL);
        };
        let along = match projection {
            Projection::Perspective => ray.direction,
            Projection::Parallel => ray.origin,
        };
        let value = constant + slope.dot(along);
        let error = 8.0 * EPS53 * (constant.abs() + slope.abs().dot(along.abs()));
        (value.abs() > error).then(|| {
            let order = ordering(Sign::of(value) * side);
            Comparison { at_sample: order, decided: order }
        })
    }
}

/// A judge with a cache of the pairs that it compared last.
///
/// Its answers are those of [`Judge`]. They come sooner where the same two flat primitives meet at many samples. The
/// cache knows primitives by names: a name must always mean the same primitive, until the judge is told to forget.
#[derive(Debug)]
pub struct CachedJudge {
    judge: Judge,
    pairs: HashMap<[u32; 2], Pair>,
    unseen: HashMap<u32, bool>,
}

impl CachedJudge {
    /// The cache holds this many pairs and this many primitives, some megabytes, and is emptied when it is full.
    const MOST: usize = 1 << 15;

    /// A judge with an empty cache.
    pub fn new(judge: Judge) -> CachedJudge {
        CachedJudge { judge, pairs: HashMap::new(), unseen: HashMap::new() }
    }

    /// [`Judge::is_edge_on`], of a primitive with a name. A primitive that is edge-on leaves every fast test open.
    pub fn is_edge_on(&mut self, name: u32, primitive: &Primitive) -> bool {
        if self.unseen.len() >= Self::MOST {
            self.unseen.clear();
        }
        let judge = &self.judge;
        *self.unseen.entry(name).or_insert_with(|| judge.is_edge_on(primitive))
    }

    /// [`Judge::nearer`], where names are in the order of the scene.
    pub fn nearer(
        &mut self,
        incoming: (u32, &Primitive),
        stored: (u32, &Primitive),
        ray: &Ray,
    ) -> bool {
        let order = self.compare(incoming, stored, ray).decided;
        order.then(incoming.0.cmp(&stored.0)).is_lt()
    }

    /// Forgets what it compared: from here on, a name may mean another primitive.
    pub fn forget(&mut self) {
        self.pairs.clear();
        self.unseen.clear();
    }

    /// Whether two primitives are equally far along every ray that meets both: they are the same, or flat
    /// and in one plane. Then the first in the scene is seen wherever both cover.
    pub fn are_tied(&mut self, first: (u32, &Primitive), second: (u32, &Primitive)) -> bool {
        are_identical(first.1, second.1)
            || matches!(self.pair(first, second), Some(Pair::SamePlane))
    }

    /// [`Judge::compare`], of primitives with names.
    pub fn compare(
        &mut self,
        first: (u32, &Primitive),
        second: (u32, &Primitive),
        ray: &Ray,
    ) -> Comparison {
        if are_identical(first.1, second.1) {
            return Comparison::EQUAL;
        }
        // Rounded arithmetic decides most pairs that cross each other: they need no place in the cache.
        if !self.pairs.contains_key(&[first.0, second.0])
            && let Some(comparison) = by_rounded_arithmetic(first.1, second.1, ray)
        {
            return comparison;
        }
        self.pair(first, second)
            .and_then(|pair| pair.compare(self.judge.projection, ray))
            .unwrap_or_else(|| self.judge.compare(first.1, second.1, ray))
    }

    /// The comparison function of two flat primitives, from the cache if it is there.
    fn pair(&mut self, first: (u32, &Primitive), second: (u32, &Primitive)) -> Option<Pair> {
        if first.1.is_round() || second.1.is_round() {
            return None;
        }
        if self.pairs.len() >= Self::MOST {
            self.pairs.clear();
        }
        let names = [first.0, second.0];
        if let Some(pair) = self.pairs.get(&names) {
            return Some(*pair);
        }
        let pair = Pair::new(&self.judge, first.1, second.1)?;
        self.pairs.insert(names, pair);
        Some(pair)
    }
}
