//! Where things stand.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::keys;
use super::linked::Draws;
use super::poisson_disk::poisson_disk;
use super::solid::Solid;
use super::value::number;
use crate::base::rng::Key;
use crate::document::{Grid, GridPlane, Ground, Param, Placement, PoissonDisk, Row};
use crate::scene::Camera;

/// Tries to find room before a slot stays empty.
const TRIES: u16 = 200;

/// The keys of a section's placement.
pub(super) struct PlaceKeys {
    place: Key,
    depth: Key,
    count: Key,
    chosen: Key,
    in_view: Key,
}

pub(super) const PEOPLE: PlaceKeys = PlaceKeys {
    place: keys::PERSON_PLACE,
    depth: keys::PERSON_DEPTH,
    count: keys::PERSON_COUNT,
    chosen: keys::PERSON_CHOSEN,
    in_view: keys::PERSON_IN_VIEW,
};

pub(super) const OCCLUDERS: PlaceKeys = PlaceKeys {
    place: keys::OCCLUDER_PLACE,
    depth: keys::OCCLUDER_DEPTH,
    count: keys::OCCLUDER_COUNT,
    chosen: keys::OCCLUDER_CHOSEN,
    in_view: keys::OCCLUDER_IN_VIEW,
};

/// What places depend on beside the placement: where the camera stands, what stands already, and how
/// much room things take.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub(super) camera: &'a Camera,
    /// Nothing may stand there, where nothing may overlap.
    pub(super) taken: &'a [Solid],
    /// What takes a slot at a position.
    pub(super) solid: &'a dyn Fn(u32, DVec3) -> Solid,
}

/// Whether a position will do, by what has been placed so far.
struct Rules<'a> {
    setting: Setting<'a>,
    draws: Draws<'a>,
    in_view_key: Key,
    no_overlap: bool,
    in_view: f64,
    placed: Vec<Solid>,
}

impl<'a> Rules<'a> {
    fn new(setting: Setting<'a>, draws: Draws<'a>, keys: &PlaceKeys, terms: (bool, f64)) -> Self {
        let (no_overlap, in_view) = terms;
        let placed = if no_overlap { setting.taken.to_vec() } else { Vec::new() };
        Self { setting, draws, in_view_key: keys.in_view, no_overlap, in_view, placed }
    }

    /// The first of some positions for a slot that will do; it is taken then.
    fn first(&mut self, slot: u32, mut tries: impl Iterator<Item = DVec3>) -> Option<DVec3> {
        let seen =
            self.in_view > 0.0 && self.draws.of(self.in_view_key, slot).uniform() < self.in_view;
        if !self.no_overlap && !seen {
            return tries.next();
        }
        let spot =
            tries.map(|point| (point, (self.setting.solid)(slot, point))).find(|(_, solid)| {
                (!seen || is_seen(self.setting.camera, solid.middle_m))
                    && !(self.no_overlap && self.placed.iter().any(|other| other.overlaps(solid)))
            });
        let (point, solid) = spot?;
        if self.no_overlap {
            self.placed.push(solid);
        }
        Some(point)
    }
}

/// Whether a point lies in the picture and not nearer than the near plane.
pub(super) fn is_seen(camera: &Camera, p_in_world: DVec3) -> bool {
    let p_in_view = camera.view_from_world(p_in_world);
    let inside = |at: DVec2| {
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        at.cmpge(DVec2::ZERO).all() && at.cmplt(size).all()
    };
    -p_in_view.z >= camera.near_m && camera.project(p_in_view).is_some_and(inside)
}

/// Slots with their positions in metres.
pub(super) struct Places {
    pub(super) points: Vec<(u32, DVec3)>,
    /// How many slots there are; one that found no room has no point.
    pub(super) wanted: u32,
}

impl Places {
    fn all(points: impl Iterator<Item = DVec3>) -> Self {
        let points: Vec<(u32, DVec3)> = (0..).zip(points).collect();
        let wanted = points.len() as u32;
        Self { points, wanted }
    }
}

pub(super) fn places(
    placement: &Placement,
    keys: &PlaceKeys,
    draws: Draws,
    setting: Setting,
) -> Places {
    match placement {
        Placement::PoissonDisk(disk) => {
            let terms = (disk.no_overlap, disk.in_view);
            on_disk(disk, keys, draws, Rules::new(setting, draws, keys, terms))
        }
        Placement::Ground(ground) => {
            let terms = (ground.no_overlap, ground.in_view);
            on_ground(ground, keys, draws, Rules::new(setting, draws, keys, terms))
        }
        Placement::Row(row) => {
            let Row { count, spacing_m, center_m } = *row;
            let plane = GridPlane::Ground;
            let grid = Grid { columns: count, rows: 1, spacing_m: [spacing_m; 2], center_m, plane };
            on_grid(&grid)
        }
        Placement::Grid(grid) => on_grid(grid),
    }
}

fn on_disk(disk: &PoissonDisk, keys: &PlaceKeys, draws: Draws, mut rules: Rules) -> Places {
    let (x, y) = (disk.x_m, disk.y_m);
    let mut stream = draws.of(keys.place, 0).stream();
    let mut points = poisson_disk(x[1] - x[0], y[1] - y[0], disk.separation_m, &mut stream);
    if let Some(count) = &disk.count {
        let wanted = rounded(count, keys, draws);
        // The pattern grows from its first point on: its beginning is a corner of it.
        let mut order = draws.of(keys.chosen, 0).stream();
        for i in 0..points.len().min(wanted as usize) {
            let other = i + order.below(points.len() - i);
            points.swap(i, other);
        }
        points.truncate(wanted as usize);
    }
    let wanted = points.len() as u32;
    let place = |(slot, p): (u32, [f64; 2])| {
        let depth = draws.of(keys.depth, slot);
        let tries = (0..TRIES).map(|lane| {
            let z = number(&disk.depth_m, depth.lane(lane));
            DVec3::new(x[0] + p[0], y[0] + p[1], z)
        });
        Some((slot, rules.first(slot, tries)?))
    };
    Places { points: (0..).zip(points).filter_map(place).collect(), wanted }
}

/// How many are wanted.
fn rounded(count: &Param, keys: &PlaceKeys, draws: Draws) -> u32 {
    number(count, draws.of(keys.count, 0)).round().max(0.0) as u32
}

/// One after the other, each where it keeps its distance from all before it.
fn on_ground(ground: &Ground, keys: &PlaceKeys, draws: Draws, mut rules: Rules) -> Places {
    let (x, z) = (ground.x_m, ground.z_m);
    let wanted = rounded(&ground.count, keys, draws);
    let mut points: Vec<(u32, DVec3)> = Vec::new();
    let mut taken = Taken::new(ground.separation_m);
    for slot in 0..wanted {
        let mut stream = draws.of(keys.place, slot).stream();
        let tries = (0..TRIES).filter_map(|_| {
            let across = x[0] + stream.uniform() * (x[1] - x[0]);
            let along = z[0] + stream.uniform() * (z[1] - z[0]);
            let point = DVec3::new(across, ground.y_m, along);
            taken.has_room(point).then_some(point)
        });
        if let Some(point) = rules.first(slot, tries) {
            taken.add(point);
            points.push((slot, point));
        }
    }
    Places { points, wanted }
}

/// The points on the ground so far, by square cells as wide as their separation.
struct Taken {
    separation_m: f64,
    cells: BTreeMap<(i64, i64), Vec<DVec3>>,
}

impl Taken {
    fn new(separation_m: f64) -> Self {
        Self { separation_m, cells: BTreeMap::new() }
    }

    fn cell_of(&self, p: DVec3) -> (i64, i64) {
        // Where no distance is kept there is nothing to look up; casts saturate.
        let index = |v: f64| (v / self.separation_m).floor() as i64;
        (index(p.x), index(p.z))
    }

    fn has_room(&self, p: DVec3) -> bool {
        if self.separation_m <= 0.0 {
            return true;
        }
        let (column, row) = self.cell_of(p);
        let near = |i: i64| i.saturating_sub(1)..=i.saturating_add(1);
        near(column).flat_map(|c| near(row).map(move |r| (c, r))).all(|cell| {
            let points = self.cells.get(&cell);
            points.is_none_or(|all| all.iter().all(|q| q.distance(p) >= self.separation_m))
        })
    }

    fn add(&mut self, p: DVec3) {
        if self.separation_m > 0.0 {
            self.cells.entry(self.cell_of(p)).or_default().push(p);
        }
    }
}

fn on_grid(grid: &Grid) -> Places {
    let center = DVec3::from_array(grid.center_m);
    let offset = |i: u32, count: u32, step: f64| (f64::from(i) - 0.5 * f64::from(count - 1)) * step;
    let [across, along] = grid.spacing_m;
    Places::all((0..grid.rows).flat_map(|row| {
        let back = -offset(row, grid.rows, along);
        let start = match grid.plane {
            GridPlane::Ground => DVec3::new(0.0, 0.0, back),
            GridPlane::Upright => DVec3::new(0.0, back, 0.0),
        };
        (0..grid.columns).map(move |c| center + start + DVec3::X * offset(c, grid.columns, across))
    }))
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    fn ground(count: f64, separation_m: f64) -> Placement {
        Placement::Ground(Ground {
            x_m: [-2.0, 3.0],
            z_m: [-1.0, 4.0],
            y_m: 0.5,
            count: Param::Constant(count),
            separation_m,
            no_overlap: false,
            in_view: 0.0,
        })
    }

    fn camera() -> Camera {
        Camera {
            width: 640,
            height: 480,
            fov_vertical_deg: 40.0,
            position_m: DVec3::new(0.0, 1.5, 6.0),
            rotation: DQuat::IDENTITY,
            near_m: 0.1,
            motion_blur: None,
            depth_of_field: None,
            distortion: None,
        }
    }

    /// People who stand upright in the camera's frame of mind.
    fn placed(placement: &Placement, draws: Draws) -> Places {
        let solid = |_, point| Solid::of_person(point, DQuat::IDENTITY, 1.0);
        let setting = Setting { camera: &camera(), taken: &[], solid: &solid };
        places(placement, &PEOPLE, draws, setting)
    }

    fn parsed(text: &str) -> Placement {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn a_count_takes_any_points_of_the_pattern() {
        let all = |count: &str| {
            parsed(&format!(
                r#"{{"mode": "poisson_disk", "depth_m": 0, "separation_m": 2.5{count}}}"#
            ))
        };
        let mut right = 0;
        for frame in 0..500 {
            let draws = Draws::new(4, frame);
            let pattern = placed(&all(""), draws);
            let few = placed(&all(r#", "count": 3"#), draws);
            let more = placed(&all(r#", "count": 5"#), draws);
            assert_eq!((few.points.len(), few.wanted), (3, 3));
            assert_eq!(few.points, more.points[..3]);
            for (_, p) in &few.points {
                assert!(pattern.points.iter().any(|(_, q)| p == q));
                right += u32::from(p.x > 0.0);
            }
            let too_many = placed(&all(r#", "count": 90"#), draws);
            assert_eq!(too_many.points.len(), pattern.points.len());
        }
        // Half of 1,500 lie right of the middle, within four standard deviations.
        assert!((672..828).contains(&right), "{right}");
    }

    #[test]
    fn nobody_overlaps_where_nobody_may() {
        for text in [
            r#"{"mode": "ground", "x_m": [-2, 2], "z_m": [-2, 2], "count": 12, "separation_m": 0"#,
            r#"{"mode": "poisson_disk", "x_m": [-2, 2], "y_m": [-2, 2], "separation_m": 0.9,
                "depth_m": {"uniform": [-2, 2]}"#,
        ] {
            let (mut free, mut apart) = (0, 0);
            for frame in 0..40 {
                let of = |more: &str| {
                    let all = placed(&parsed(&format!("{text}{more}}}")), Draws::new(4, frame));
                    let solid = |p: &(u32, DVec3)| Solid::of_person(p.1, DQuat::IDENTITY, 1.0);
                    all.points.iter().map(solid).collect::<Vec<_>>()
                };
                let overlaps = |all: &[Solid]| {
                    let clash = |i: usize| all[..i].iter().any(|other| other.overlaps(&all[i]));
                    (0..all.len()).filter(|i| clash(*i)).count()
                };
                free += overlaps(&of(""));
                let kept = of(r#", "no_overlap": true"#);
                assert_eq!(overlaps(&kept), 0);
                apart += kept.len();
            }
            assert!(free > 40 && apart > 300, "{text}: {free} {apart}");
        }
    }

    #[test]
    fn as_many_are_in_view_as_must_be() {
        let text = r#"{"mode": "ground", "x_m": [-20, 20], "z_m": [-20, 20], "count": 10,
            "separation_m": 0.5, "in_view": "#;
        let share = |in_view: f64| {
            let placement = parsed(&format!("{text}{in_view}}}"));
            let all: Vec<_> =
                (0..200).flat_map(|f| placed(&placement, Draws::new(4, f)).points).collect();
            assert_eq!(all.len(), 2000);
            let middle = |p: &DVec3| *p + DVec3::Y * 0.9;
            all.iter().filter(|(_, p)| is_seen(&camera(), middle(p))).count() as f64 / 2000.0
        };
        let by_chance = share(0.0);
        assert!((0.05..0.5).contains(&by_chance), "{by_chance}");
        assert_eq!(share(1.0), 1.0);
        let expected = 0.6 + 0.4 * by_chance;
        assert!((share(0.6) - expected).abs() < 0.04, "{expected}");
    }

    #[test]
    fn people_on_the_ground_keep_their_distance() {
        for frame in 0..50 {
            let Places { points, wanted } = placed(&ground(6.0, 1.0), Draws::new(4, frame));
            assert_eq!((points.len(), wanted), (6, 6));
            for (i, (slot, p)) in points.iter().enumerate() {
                assert_eq!(*slot, i as u32);
                assert!((-2.0..3.0).contains(&p.x) && (-1.0..4.0).contains(&p.z) && p.y == 0.5);
                assert!(points[..i].iter().all(|(_, q)| p.distance(*q) >= 1.0));
            }
        }
    }

    #[test]
    fn more_people_leave_the_first_ones_where_they_are() {
        let few = placed(&ground(4.0, 1.0), Draws::new(4, 9)).points;
        let many = placed(&ground(9.0, 1.0), Draws::new(4, 9)).points;
        assert_eq!(few, many[..4]);
    }

    #[test]
    fn who_finds_no_room_is_left_out() {
        let Places { points, wanted } = placed(&ground(60.0, 1.0), Draws::new(4, 0));
        assert_eq!(wanted, 60);
        assert!((10..40).contains(&points.len()), "{}", points.len());
    }

    #[test]
    fn a_row_is_centred() {
        let row = Row { count: 3, spacing_m: 0.5, center_m: [1.0, 0.0, -2.0] };
        let points = placed(&Placement::Row(row), Draws::new(4, 0)).points;
        let x: Vec<f64> = points.iter().map(|(_, p)| p.x).collect();
        assert_eq!(x, [0.5, 1.0, 1.5]);
        assert!(points.iter().all(|(_, p)| p.z == -2.0));
        for (plane, back) in [(GridPlane::Ground, DVec3::Z), (GridPlane::Upright, DVec3::Y)] {
            let (spacing_m, center_m) = ([1.0, 3.0], [0.0; 3]);
            let grid = Grid { columns: 2, rows: 2, spacing_m, center_m, plane };
            let points = placed(&Placement::Grid(grid), Draws::new(4, 0)).points;
            assert_eq!(points[0].1, DVec3::new(-0.5, 0.0, 0.0) + 1.5 * back);
            assert_eq!(points[3].1, DVec3::new(0.5, 0.0, 0.0) - 1.5 * back);
        }
    }
}
