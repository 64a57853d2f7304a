//! The list of schemes.

use super::lanes::{self, Kernels};
use super::rule::{Rule, Smoothness, Velocities};
use super::span::Span;
use super::{
    Arc, Rates, b_spline, barry_goldman, bessel, bessel_overhauser, catmull_rom, kochanek_bartels,
    natural_c2, nlerp, slerp, squad, step,
};
use crate::math::{Quat, Scalar};

macro_rules! kernels {
    (broad, $rule:path) => {
        Some(Kernels::of::<$rule>())
    };
    (single, $rule:path) => {
        None
    };
}

macro_rules! schemes {
    ($($listed:ident,)*; $($name:ident = $rule:path: $breadth:ident,)*) => {
        /// How rotations run from key to key.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[expect(missing_docs, reason = "each scheme's own file and page describe it")]
        pub enum Scheme { $($name,)* }

        /// The curve of one scheme between two keys.
        #[derive(Clone, Copy, Debug)]
        pub(super) enum Segment { $($name(<$rule as Rule>::Arc),)* }

        impl Scheme {
            /// Every scheme that LINEAR samples can show, in the order of the documentation.
            pub const ALL: &'static [Scheme] = &[$(Scheme::$listed,)*];

            /// The same, and those that only STEP samples can show.
            pub const EVERY: &'static [Scheme] = &[$(Scheme::$name,)*];

            /// The name by which users choose it.
            pub fn name(self) -> &'static str {
                match self { $(Scheme::$name => <$rule as Rule>::NAME,)* }
            }

            /// What it is, in a line.
            pub fn summary(self) -> &'static str {
                match self { $(Scheme::$name => <$rule as Rule>::SUMMARY,)* }
            }

            /// Where its motion is smooth.
            pub fn smoothness(self) -> Smoothness {
                match self { $(Scheme::$name => <$rule as Rule>::SMOOTHNESS,)* }
            }

            /// Whether the motion meets every key: else it smooths.
            pub fn passes_keys(self) -> bool {
                match self { $(Scheme::$name => <$rule as Rule>::PASSES_KEYS,)* }
            }

            /// Whether more than a segment's own two keys shape it: else ends and neighbours
            /// change nothing.
            pub fn has_ends(self) -> bool {
                match self { $(Scheme::$name => <$rule as Rule>::HAS_ENDS,)* }
            }

            pub(super) fn velocities(self) -> Option<Velocities> {
                match self { $(Scheme::$name => <$rule as Rule>::VELOCITIES,)* }
            }

            /// The vector code of its segments, if there is any.
            pub(super) fn kernels(self) -> Option<Kernels> {
                match self { $(Scheme::$name => kernels!($breadth, $rule),)* }
            }

            pub(super) fn segment(self, span: &Span) -> Segment {
                match self { $(Scheme::$name => Segment::$name(<$rule as Rule>::arc(span)),)* }
            }
        }

        impl Segment {
            /// The rotations at many parameters, by vector code.
            pub(super) fn fill(&self, us: &[f64], out: &mut [Quat]) {
                match self { $(Segment::$name(arc) => lanes::fill(arc, us, out),)* }
            }
        }

        impl Arc for Segment {
            fn at<S: Scalar>(&self, u: S) -> Quat<S> {
                match self { $(Segment::$name(arc) => arc.at(u),)* }
            }

            fn rates(&self) -> Rates {
                match self { $(Segment::$name(arc) => arc.rates(),)* }
            }
        }
    };
}

schemes! {
    Slerp, Squad, CatmullRom, BesselOverhauser, Bessel, KochanekBartels, BarryGoldman, NaturalC2, BSpline, Nlerp,;
    Slerp = slerp::Slerp: broad,
    Squad = squad::Squad: broad,
    CatmullRom = catmull_rom::CatmullRom: broad,
    BesselOverhauser = bessel_overhauser::BesselOverhauser: broad,
    Bessel = bessel::Bessel: broad,
    KochanekBartels = kochanek_bartels::KochanekBartels: broad,
    BarryGoldman = barry_goldman::BarryGoldman: broad,
    NaturalC2 = natural_c2::NaturalC2: single,
    BSpline = b_spline::BSpline: single,
    Nlerp = nlerp::Nlerp: single,
    Step = step::Step: single,
}

impl Scheme {
    /// Whether its motion is held from key to key and jumps: what only STEP channels show.
    pub fn is_step(self) -> bool {
        self.smoothness() == Smoothness::Jumps
    }

    /// Whether tension, continuity and bias shape it.
    pub fn has_tcb(self) -> bool {
        self == Scheme::KochanekBartels
    }

    /// The scheme of a name, if there is one.
    pub fn from_name(name: &str) -> Option<Scheme> {
        Scheme::EVERY.iter().copied().find(|scheme| scheme.name() == name)
    }
}
