//! Vectors of three scalars: axes, rotation vectors, angular velocities.

use super::Scalar;
use super::scalar::norm;
use std::ops::{Add, Mul, Neg, Sub};

/// A vector in three dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs)]
pub struct Vec3<S = f64> {
    pub x: S,
    pub y: S,
    pub z: S,
}

impl Vec3 {
    /// The zero vector.
    pub const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);

    /// Length; does not overflow or underflow before the length itself does.
    pub fn length(self) -> f64 {
        norm([self.x, self.y, self.z])
    }
}

impl<S> Vec3<S> {
    /// The vector (x, y, z).
    #[inline(always)]
    pub const fn new(x: S, y: S, z: S) -> Self {
        Vec3 { x, y, z }
    }
}

impl<S: Scalar> Vec3<S> {
    /// The same vector in another kind of scalar.
    #[inline(always)]
    pub fn constant<N>(v: Vec3<N>) -> Self
    where
        S: From<N>,
    {
        Vec3::new(S::from(v.x), S::from(v.y), S::from(v.z))
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> S {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product, right-handed.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Vec3::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Vec3::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Vec3::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Vec3::new(-self.x, -self.y, -self.z)
    }
}

impl<S: Scalar> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Vec3::new(self.x * s, self.y * s, self.z * s)
    }
}
