//! Randomised vectors, rotations and colours as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Param;

/// Three numbers: one parameter an axis, or drawn together from a shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Vector {
    /// x, y and z, drawn independently.
    Axes([Param; 3]),
    /// Drawn together.
    Joint(Region),
}

/// A shape that points are drawn from evenly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// The inside of a sphere.
    Sphere(Round),
    /// A level disk, normal y.
    Disk(Round),
    /// The inside of a box.
    Box(BoxRegion),
    /// The nodes of a lattice, faces included.
    Grid(GridRegion),
}

/// Centre and radius of a sphere or disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// Its middle.
    #[serde(default)]
    pub center: [f64; 3],
    /// Its radius.
    pub radius: f64,
}

/// A box along the axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxRegion {
    /// Lowest corner.
    pub min: [f64; 3],
    /// Highest corner.
    pub max: [f64; 3],
}

/// A lattice over a box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridRegion {
    /// Lowest corner.
    pub min: [f64; 3],
    /// Highest corner.
    pub max: [f64; 3],
    /// Nodes per axis; a single one lies at `min`.
    pub nodes: [u32; 3],
}

impl Vector {
    /// Always the same.
    #[must_use]
    pub const fn constant(x: f64, y: f64, z: f64) -> Self {
        Self::Axes([Param::Constant(x), Param::Constant(y), Param::Constant(z)])
    }

    /// Evenly over the cube `[-half, half)` about the origin.
    #[must_use]
    pub const fn within(half: f64) -> Self {
        Self::Axes([
            Param::uniform(-half, half),
            Param::uniform(-half, half),
            Param::uniform(-half, half),
        ])
    }

    /// The smallest interval per axis that holds every value it can take.
    #[must_use]
    pub fn bounds(&self) -> [(f64, f64); 3] {
        match self {
            Self::Axes(axes) => [0, 1, 2].map(|i| axes[i].bounds()),
            Self::Joint(Region::Sphere(s)) => s.center.map(|c| (c - s.radius, c + s.radius)),
            Self::Joint(Region::Disk(d)) => {
                let [x, y, z] = d.center;
                [(x - d.radius, x + d.radius), (y, y), (z - d.radius, z + d.radius)]
            }
            Self::Joint(Region::Box(b)) => [0, 1, 2].map(|i| (b.min[i], b.max[i])),
            Self::Joint(Region::Grid(g)) => [0, 1, 2].map(|i| (g.min[i], g.max[i])),
        }
    }
}

/// An orientation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Rotation {
    /// Degrees about x, y and z, applied about z, then x, then y.
    Euler([Param; 3]),
    /// Drawn together.
    Joint(JointRotation),
}

/// An orientation that is drawn as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointRotation {
    /// By this law.
    Rotation(RotationLaw),
    /// Upright, the front towards something; for people and occluders.
    Facing(Facing),
}

/// Upright, with the front (+Z at rest) towards something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Facing {
    /// Towards what.
    pub towards: Towards,
    /// Turned away from it, to the left.
    #[serde(default)]
    pub yaw_deg: Param,
}

/// What is faced.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Towards {
    /// The camera.
    Camera(CameraWord),
    /// A point, metres.
    Point([f64; 3]),
}

/// The word `"camera"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CameraWord {
    /// The camera of the frame.
    Camera,
}

/// A law for orientations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RotationLaw {
    /// Every orientation equally likely (the Haar measure of SO(3)).
    Uniform,
}

impl Rotation {
    /// None.
    pub const NONE: Self =
        Self::Euler([Param::Constant(0.0), Param::Constant(0.0), Param::Constant(0.0)]);

    /// Any direction about the vertical.
    pub const YAW: Self =
        Self::Euler([Param::Constant(0.0), Param::uniform(0.0, 360.0), Param::Constant(0.0)]);
}

/// A colour. Three numbers are sRGB, 0..1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Color {
    /// Red, green and blue in sRGB, 0..1.
    Srgb([Param; 3]),
    /// In another way.
    Other(ColorLaw),
}

/// Other ways to give a colour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorLaw {
    /// Hue in degrees, saturation and value 0..1, of sRGB.
    Hsv([Param; 3]),
    /// Linear red, green and blue, 0..1.
    Linear([Param; 3]),
    /// sRGB colours with their weights.
    Palette(Vec<([f64; 3], f64)>),
    /// Weights and the colours they stand for.
    Mix(Vec<(f64, Color)>),
}

impl Color {
    /// Always the same, sRGB.
    #[must_use]
    pub const fn srgb(r: f64, g: f64, b: f64) -> Self {
        Self::Srgb([Param::Constant(r), Param::Constant(g), Param::Constant(b)])
    }

    /// White.
    pub const WHITE: Self = Self::srgb(1.0, 1.0, 1.0);
}
