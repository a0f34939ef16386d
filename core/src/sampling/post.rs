//! Exposure, and what else happens to the light behind the lens.

use super::keys;
use super::linked::Draws;
use super::value::number;
use crate::document;
use crate::scene::Post;

pub(super) fn exposure_ev100(post: &document::Post, draws: Draws) -> f64 {
    let draws = draws.random_if(post.enabled);
    number(&post.exposure_ev, draws.of(keys::EXPOSURE, 0))
        - number(&post.compensation_ev, draws.of(keys::COMPENSATION, 0))
}

pub(super) fn post(post: &document::Post, draws: Draws) -> Post {
    if !post.enabled {
        return Post { tone_curve: post.tone_curve, ..Post::default() };
    }
    let of = |param, key| number(param, draws.of(key, 0));
    Post {
        bloom: of(&post.bloom, keys::BLOOM),
        bloom_scatter: of(&post.bloom_scatter, keys::BLOOM_SCATTER),
        vignette: of(&post.vignette, keys::VIGNETTE),
        shot_noise: of(&post.shot_noise, keys::SHOT_NOISE),
        read_noise: of(&post.read_noise, keys::READ_NOISE),
        white_balance_temperature: of(&post.white_balance_temperature, keys::TEMPERATURE),
        white_balance_tint: of(&post.white_balance_tint, keys::TINT),
        contrast: of(&post.contrast, keys::CONTRAST),
        saturation: of(&post.saturation, keys::SATURATION),
        tone_curve: post.tone_curve,
        grain: of(&post.grain, keys::GRAIN),
        grain_key: (draws.of(keys::GRAIN_NOISE, 0).uniform() * 4_294_967_296.0) as u32,
    }
}
