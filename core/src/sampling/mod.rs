//! (document, catalogue, frame) -> scene: every number settled.
//!
//! Each value is keyed by its name and its slot (`keys`), so that frames need no order, and a
//! section that is switched off moves no value of another. One file per section of the document.
//! What the assets look like is not known here: a [`Catalogue`] holds their names.

use std::sync::Arc;

use crate::document::cast::Member;
use crate::document::{Choice, Distribution, Document, Problem, file::Problems, params, validate};
use crate::library::pose::Wear;
use crate::scene::{Person, Scene};

mod address;
mod background;
mod blackbody;
mod body;
mod camera;
mod cast;
mod expression;
mod growth;
mod keys;
mod lights;
mod linked;
mod look;
mod outfit;
mod outfit_table;
mod output;
mod people;
mod place;
mod poisson_disk;
mod pose;
mod post;
mod quantile;
mod solid;
mod style;
mod value;

use linked::{Draws, Links};

/// The names of all assets that a document may use, each list in a stable order: it is part of
/// what a seed means.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Catalogue {
    /// Local face targets of the figure. Those named `l-...` and `r-...` alike are one shape.
    pub face_targets: Vec<String>,
    /// Units of expression and gaze of the figure's face.
    pub face_units: Vec<String>,
    /// Motion clips.
    pub clips: Vec<Activity>,
    /// Poses.
    pub poses: Vec<Activity>,
    /// Textures for walls, floors and occluders.
    pub textures: Vec<String>,
    /// Patterns of cloth.
    pub cloth_patterns: Vec<String>,
    /// Ways in which cloth is woven.
    pub cloth_reliefs: Vec<String>,
    /// Finishes of cloth.
    pub cloth_finishes: Vec<String>,
    /// Pictures of all directions.
    pub environments: Vec<String>,
}

/// A clip or a pose by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Activity {
    /// Its id in the library.
    pub id: String,
    /// What a person does who follows it.
    pub activity: String,
    /// Whether that needs something to sit on.
    pub seated: bool,
    /// What nobody does it in.
    pub unsuited: Vec<Wear>,
}

/// Why a frame could not be sampled.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SampleError {
    /// The document makes no sense.
    #[error("{0}")]
    Document(Problems),
    /// The document names assets that are not there.
    #[error("{0}")]
    Assets(Problems),
}

/// How many found a place in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// People that the placement asked for.
    pub people_wanted: u32,
    /// People that stand in the scene, seen or not.
    pub people: u32,
    /// Occluders that the placement asked for.
    pub occluders_wanted: u32,
    /// Occluders that stand in the scene.
    pub occluders: u32,
}

/// A document that was found valid, with the assets that it draws from.
#[derive(Clone, Debug)]
pub struct Sampler {
    document: Arc<Document>,
    catalogue: Catalogue,
    faces: Vec<look::FaceShape>,
    links: Links,
}

impl Sampler {
    /// Checks a document once for all its frames.
    ///
    /// # Errors
    /// When the document makes no sense or names assets that the catalogue does not hold.
    pub fn new(document: Arc<Document>, catalogue: Catalogue) -> Result<Self, SampleError> {
        let problems = validate(&document);
        if !problems.is_empty() {
            return Err(SampleError::Document(Problems(problems)));
        }
        let problems = check_assets(&document, &catalogue);
        if !problems.is_empty() {
            return Err(SampleError::Assets(Problems(problems)));
        }
        let faces = look::face_shapes(&catalogue.face_targets);
        let links = Links::new(&document);
        Ok(Self { document, catalogue, faces, links })
    }

    /// The document.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// One frame. It depends on the document and the catalogue alone.
    #[must_use]
    pub fn scene(&self, frame: u32) -> Scene {
        let Self { document, catalogue, faces, links } = self;
        let draws = Draws::linked(document.seed, frame, links);
        let mut camera = camera::camera(document, draws);
        let people = people::people(document, catalogue, faces, draws, &camera);
        camera::focus(&document.camera.depth_of_field, &mut camera, &people);
        Scene {
            frame,
            seed: document.seed,
            camera,
            lights: lights::lights(&document.lights, &catalogue.environments, draws),
            exposure_ev100: post::exposure_ev100(&document.post, draws),
            post: post::post(&document.post, draws),
            objects: background::objects(document, catalogue, draws, &camera),
            people,
            jpeg_quality: output::jpeg_quality(&document.output, draws),
        }
    }
}

impl Sampler {
    /// Everybody who recurs over the frames, in the order of their ids, as the config could list
    /// them; nobody where nobody recurs. What an `each` sets is that of the slot of the same number.
    pub fn members(&self) -> impl ExactSizeIterator<Item = Member> {
        let Self { document, catalogue, faces, links } = self;
        let count = document.people.identity_count().unwrap_or(0);
        let of = move |id| Draws::linked(document.seed, id, links);
        (0..count).map(move |id| people::member(&document.people, catalogue, faces, of(id), id))
    }

    /// Everybody who stands in a frame, by their instance ids (slot plus one), as the config could
    /// list them.
    #[must_use]
    pub fn members_of_frame(&self, frame: u32) -> Vec<(u32, Member)> {
        let Self { document, catalogue, faces, links } = self;
        let draws = Draws::linked(document.seed, frame, links);
        let camera = camera::camera(document, draws);
        let people = people::people(document, catalogue, faces, draws, &camera);
        let member = |p: Person| {
            let what = (&p.body, &p.look, &p.outfit);
            (p.slot + 1, cast::member(p.name.as_deref(), what, &cast::dyed(&p.outfit), catalogue))
        };
        people.into_iter().map(member).collect()
    }
}

/// How many people and occluders a frame holds. The document must be valid.
#[must_use]
pub fn counts(document: &Document, frame: u32) -> Counts {
    let links = Links::new(document);
    let draws = Draws::linked(document.seed, frame, &links);
    let camera = camera::camera(document, draws);
    let people = people::Standing::new(&document.people, draws, &camera).places();
    let occluders = background::occluder_places(document, draws, &camera);
    Counts {
        people_wanted: people.wanted,
        people: people.points.len() as u32,
        occluders_wanted: occluders.wanted,
        occluders: occluders.points.len() as u32,
    }
}

/// The ids in a document that a catalogue does not hold, and wishes for `"any"` asset of a kind
/// of which there is none. What is switched off may name anything.
#[must_use]
pub fn check_assets(document: &Document, catalogue: &Catalogue) -> Vec<Problem> {
    let (wall, floor) = (&document.background.wall, &document.background.floor);
    let (occluders, people) = (&document.occluders, &document.people);
    let textures = ("texture", &catalogue.textures, true);
    let patterns = ("cloth pattern", &catalogue.cloth_patterns, true);
    let reliefs = ("relief of cloth", &catalogue.cloth_reliefs, true);
    let finishes = ("finish of cloth", &catalogue.cloth_finishes, true);
    let (top, bottom) = (&people.wardrobe.top, &people.wardrobe.bottom);
    let outer = &people.wardrobe.outer;
    let environment = &document.lights.environment;
    let mut pictures = catalogue.environments.clone();
    pictures.push(lights::SKY.to_owned());
    let surroundings = ("picture of surroundings", &pictures, true);
    let all = [
        (
            environment.enabled,
            "lights.environment.image.source",
            &environment.image.source,
            surroundings,
        ),
        (wall.enabled, "background.wall.texture", &wall.texture, textures),
        (floor.enabled, "background.floor.texture", &floor.texture, textures),
        (occluders.enabled, "occluders.texture", &occluders.texture, textures),
        (people.enabled, "people.wardrobe.top.pattern", &top.pattern, patterns),
        (people.enabled, "people.wardrobe.bottom.pattern", &bottom.pattern, patterns),
        (people.enabled, "people.wardrobe.outer.pattern", &outer.pattern, patterns),
        (people.enabled, "people.wardrobe.top.relief", &top.relief, reliefs),
        (people.enabled, "people.wardrobe.bottom.relief", &bottom.relief, reliefs),
        (people.enabled, "people.wardrobe.outer.relief", &outer.relief, reliefs),
        (people.enabled, "people.wardrobe.top.finish", &top.finish, finishes),
        (people.enabled, "people.wardrobe.bottom.finish", &bottom.finish, finishes),
        (people.enabled, "people.wardrobe.outer.finish", &outer.finish, finishes),
    ];
    let mut problems = unread(document);
    for (enabled, path, choice, (kind, known, none_allowed)) in all {
        if enabled {
            check_choice(path, choice, kind, known, none_allowed, &mut problems);
        }
    }
    if people.enabled {
        cast::check(people, catalogue, &mut problems);
        check_poses("people.pose.clip", &people.pose.clip, catalogue, &mut problems);
        // What has no share is never looked up.
        if people.pose.blend.share.bounds().1 > 0.0 {
            let second = &people.pose.blend.clip;
            check_poses("people.pose.blend.clip", second, catalogue, &mut problems);
        }
    }
    problems
}

/// Tables that nobody has read.
fn unread(document: &Document) -> Vec<Problem> {
    let params = params(document);
    let laws = params.iter().flat_map(|(path, param)| param.laws(path));
    let tables = laws.filter(|(_, law)| matches!(law, Distribution::Empirical(_)));
    let what = "the file was not read; load the config from its own file";
    tables.map(|(path, _)| Problem::new(format!("{path}.empirical"), what)).collect()
}

/// Clips and poses share one set of ids.
fn check_poses(
    path: &str,
    choice: &Choice<String>,
    catalogue: &Catalogue,
    problems: &mut Vec<Problem>,
) {
    let (clips, poses) = (&catalogue.clips, &catalogue.poses);
    for id in choice.possible() {
        let (kind, there) = match id.as_str() {
            "any" => ("clip or pose", !clips.is_empty() || !poses.is_empty()),
            "any_clip" => ("clip", !clips.is_empty()),
            "any_pose" => ("pose", !poses.is_empty()),
            id => {
                let mut known = clips.iter().chain(poses).map(|a| a.id.as_str());
                if !known.clone().any(|k| k == id) {
                    let problem = Problem::new(path, format!("there is no clip or pose \"{id}\""));
                    problems.push(problem.did_you_mean(id, &mut known));
                }
                continue;
            }
        };
        if !there {
            let message = format!("\"{id}\" needs at least one {kind}: the library holds none");
            problems.push(Problem::new(path, message));
        }
    }
}

fn check_choice(
    path: &str,
    choice: &Choice<String>,
    kind: &str,
    known: &[String],
    none_allowed: bool,
    problems: &mut Vec<Problem>,
) {
    for id in choice.possible() {
        match id.as_str() {
            "none" if none_allowed => {}
            "any" if known.is_empty() => {
                let advice = if kind == "texture" {
                    "name a folder of JPEG or PNG files in `assets`, or write \"none\""
                } else {
                    "the library holds none"
                };
                problems.push(Problem::new(
                    path,
                    format!("\"any\" needs at least one {kind}: {advice}"),
                ));
            }
            "any" => {}
            id if known.iter().any(|k| k == id) => {}
            id => {
                let problem = Problem::new(path, format!("there is no {kind} \"{id}\""));
                problems.push(problem.did_you_mean(id, known.iter().map(String::as_str)));
            }
        }
    }
}
