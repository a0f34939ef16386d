//! (document, catalogue, frame) -> scene.
