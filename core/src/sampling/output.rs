//! How a frame is stored.

use super::keys;
use super::linked::Draws;
use super::value::number;
use crate::document::{ImageFormat, Output, Param};

/// The quality of a frame's JPEG, 1..100, where the config draws it; one for all frames is no number of
/// a frame.
pub(super) fn jpeg_quality(output: &Output, draws: Draws) -> Option<u8> {
    let drawn = output.image_format == ImageFormat::Jpeg
        && !matches!(output.jpeg_quality, Param::Constant(_));
    drawn.then(|| number(&output.jpeg_quality, draws.of(keys::JPEG_QUALITY, 0)).round() as u8)
}
