//! Numbers that look random.

use bothways_common::glam::{DVec3, Vec3};

/// Numbers that look random, the same in every run.
#[derive(Clone, Debug)]
pub struct Dice(pub u64);

impl Dice {
    /// A number in −1 … 1.
    #[expect(clippy::should_implement_trait, reason = "it never ends")]
    pub fn next(&mut self) -> f32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1_u64 << 24) as f32 * 2.0 - 1.0
    }

    /// A point in a cube; each coordinate is such a number.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    /// The same in `f64`.
    pub fn vector(&mut self) -> DVec3 {
        self.point().as_dvec3()
    }

    /// Ten to a power between these two.
    pub fn power(&mut self, [least, most]: [f64; 2]) -> f64 {
        10f64.powf(0.5 * (least + most + (most - least) * f64::from(self.next())))
    }
}
