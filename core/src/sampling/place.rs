//! Where things stand.

use std::collections::BTreeMap;

use glam::DVec3;

use super::keys;
use super::linked::Draws;
use super::poisson_disk::poisson_disk;
use super::value::number;
use crate::base::rng::Key;
use crate::document::{Grid, GridPlane, Ground, Placement, PoissonDisk, Row};

/// Tries to find room on the ground before a slot stays empty.
const TRIES: u32 = 200;

/// The keys of a section's placement.
pub(super) struct PlaceKeys {
    place: Key,
    depth: Key,
    count: Key,
}

pub(super) const PEOPLE: PlaceKeys =
    PlaceKeys { place: keys::PERSON_PLACE, depth: keys::PERSON_DEPTH, count: keys::PERSON_COUNT };

pub(super) const OCCLUDERS: PlaceKeys = PlaceKeys {
    place: keys::OCCLUDER_PLACE,
    depth: keys::OCCLUDER_DEPTH,
    count: keys::OCCLUDER_COUNT,
};

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

pub(super) fn places(placement: &Placement, keys: &PlaceKeys, draws: Draws) -> Places {
    match placement {
        Placement::PoissonDisk(disk) => on_disk(disk, keys, draws),
        Placement::Ground(ground) => on_ground(ground, keys, draws),
        Placement::Row(row) => {
            let Row { count, spacing_m, center_m } = *row;
            let plane = GridPlane::Ground;
            let grid = Grid { columns: count, rows: 1, spacing_m: [spacing_m; 2], center_m, plane };
            on_grid(&grid)
        }
        Placement::Grid(grid) => on_grid(grid),
    }
}

fn on_disk(disk: &PoissonDisk, keys: &PlaceKeys, draws: Draws) -> Places {
    let (x, y) = (disk.x_m, disk.y_m);
    let mut stream = draws.of(keys.place, 0).stream();
    let points = poisson_disk(x[1] - x[0], y[1] - y[0], disk.separation_m, &mut stream);
    Places::all((0..).zip(points).map(|(slot, p)| {
        let z = number(&disk.depth_m, draws.of(keys.depth, slot));
        DVec3::new(x[0] + p[0], y[0] + p[1], z)
    }))
}

/// One after the other, each where it keeps its distance from all before it.
fn on_ground(ground: &Ground, keys: &PlaceKeys, draws: Draws) -> Places {
    let (x, z) = (ground.x_m, ground.z_m);
    let wanted = number(&ground.count, draws.of(keys.count, 0)).round().max(0.0) as u32;
    let mut points: Vec<(u32, DVec3)> = Vec::new();
    let mut taken = Taken::new(ground.separation_m);
    for slot in 0..wanted {
        let mut stream = draws.of(keys.place, slot).stream();
        let spot = (0..TRIES).find_map(|_| {
            let across = x[0] + stream.uniform() * (x[1] - x[0]);
            let along = z[0] + stream.uniform() * (z[1] - z[0]);
            let point = DVec3::new(across, ground.y_m, along);
            taken.has_room(point).then_some(point)
        });
        if let Some(point) = spot {
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
    use super::*;
    use crate::document::Param;

    fn ground(count: f64, separation_m: f64) -> Placement {
        Placement::Ground(Ground {
            x_m: [-2.0, 3.0],
            z_m: [-1.0, 4.0],
            y_m: 0.5,
            count: Param::Constant(count),
            separation_m,
        })
    }

    #[test]
    fn people_on_the_ground_keep_their_distance() {
        for frame in 0..50 {
            let Places { points, wanted } =
                places(&ground(6.0, 1.0), &PEOPLE, Draws::new(4, frame));
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
        let few = places(&ground(4.0, 1.0), &PEOPLE, Draws::new(4, 9)).points;
        let many = places(&ground(9.0, 1.0), &PEOPLE, Draws::new(4, 9)).points;
        assert_eq!(few, many[..4]);
    }

    #[test]
    fn who_finds_no_room_is_left_out() {
        let Places { points, wanted } = places(&ground(60.0, 1.0), &PEOPLE, Draws::new(4, 0));
        assert_eq!(wanted, 60);
        assert!((10..40).contains(&points.len()), "{}", points.len());
    }

    #[test]
    fn a_row_is_centred() {
        let row = Row { count: 3, spacing_m: 0.5, center_m: [1.0, 0.0, -2.0] };
        let points = places(&Placement::Row(row), &PEOPLE, Draws::new(4, 0)).points;
        let x: Vec<f64> = points.iter().map(|(_, p)| p.x).collect();
        assert_eq!(x, [0.5, 1.0, 1.5]);
        assert!(points.iter().all(|(_, p)| p.z == -2.0));
        for (plane, back) in [(GridPlane::Ground, DVec3::Z), (GridPlane::Upright, DVec3::Y)] {
            let (spacing_m, center_m) = ([1.0, 3.0], [0.0; 3]);
            let grid = Grid { columns: 2, rows: 2, spacing_m, center_m, plane };
            let points = places(&Placement::Grid(grid), &PEOPLE, Draws::new(4, 0)).points;
            assert_eq!(points[0].1, DVec3::new(-0.5, 0.0, 0.0) + 1.5 * back);
            assert_eq!(points[3].1, DVec3::new(0.5, 0.0, 0.0) - 1.5 * back);
        }
    }
}
