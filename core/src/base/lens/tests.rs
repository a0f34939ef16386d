use super::*;

const BARREL: Lens = Lens::Brown { k1: -0.28, k2: 0.09, p1: 0.0011, p2: -0.0007, k3: -0.012 };
const CUSHION: Lens = Lens::Brown { k1: 0.15, k2: -0.05, p1: -0.003, p2: 0.002, k3: 0.01 };
const EQUIDISTANT: Lens = Lens::Fisheye { k1: 0.0, k2: 0.0, k3: 0.0, k4: 0.0 };
const FISHEYE: Lens = Lens::Fisheye { k1: -0.02, k2: 0.006, k3: -0.003, k4: 0.0004 };

/// Pixels as OpenCV 5.0.0 computed them (`cv2.projectPoints`, `cv2.fisheye.projectPoints`) for four
/// points and `K = [[500, 0, 320], [0, 480, 240], [0, 0, 1]]`.
const OPENCV: [(Lens, [[f64; 2]; 4]); 4] = [
    (
        BARREL,
        [
            [407.079_548_371_864_06, 184.282_763_782_491_43],
            [72.935_607_812_499_97, 391.067_410_499_999_94],
            [575.990_928_395_061_7, 458.978_332_971_193_37],
            [321.666_589_074_537_06, 236.800_140_976_888_88],
        ],
    ),
    (
        CUSHION,
        [
            [408.991_356_898_012_9, 183.009_545_426_102_22],
            [31.348_738_281_249_95, 415.98731625],
            [643.977_744_855_967_1, 514.983_083_017_832_7],
            [321.666_824_999_742_8, 236.799_722_667_160_5],
        ],
    ),
    (
        EQUIDISTANT,
        [
            [406.946_872_788_307_25, 184.354_001_415_483_34],
            [76.298_279_874_918_68, 388.879_596_294_595_1],
            [572.784_853_288_463_1, 455.709_741_472_821_86],
            [321.666_635_803_497_9, 236.800_059_257_284_03],
        ],
    ),
    (
        FISHEYE,
        [
            [406.871_892_089_453_6, 184.401_989_062_749_7],
            [77.788_146_487_272_91, 387.969_423_236_865_96],
            [570.720_906_645_271_4, 453.948_507_003_964_95],
            [321.666_633_951_779_8, 236.800_062_812_582_8],
        ],
    ),
];
const POINTS: [[f64; 3]; 4] =
    [[0.3, -0.2, 1.7], [-1.1, 0.7, 2.0], [0.9, 0.8, 1.5], [0.01, -0.02, 3.0]];

#[test]
fn points_project_as_opencv_projects_them() {
    for (lens, pixels) in OPENCV {
        for ([x, y, z], pixel) in POINTS.into_iter().zip(pixels) {
            let distorted = lens.distort(DVec2::new(x, y) / z);
            let px = distorted * DVec2::new(500.0, 480.0) + DVec2::new(320.0, 240.0);
            assert!(
                px.distance(DVec2::from_array(pixel)) < 1e-9,
                "{lens:?}: {px} is not {pixel:?}"
            );
        }
    }
}

#[test]
fn the_way_back_leads_back() {
    for (lens, _) in OPENCV {
        for x in -20..=20 {
            for y in -20..=20 {
                let u = DVec2::new(f64::from(x), f64::from(y)) * 0.04;
                let back = lens.undistort(lens.distort(u)).unwrap();
                assert!(back.distance(u) < 1e-9, "{lens:?}: {u} became {back}");
            }
        }
    }
}

#[test]
fn jacobians_are_the_change_of_what_they_are_of() {
    for (lens, _) in OPENCV {
        let p = lens.polynomial();
        for v in [DVec2::new(0.3, -0.5), DVec2::new(-0.7, 0.2), DVec2::ZERO] {
            let step = 1e-6;
            let change = |d: DVec2| (p.distort(v + d) - p.distort(v - d)) / (2.0 * step);
            let by_hand = DMat2::from_cols(change(DVec2::X * step), change(DVec2::Y * step));
            assert!(p.jacobian(v).abs_diff_eq(by_hand, 1e-8), "{lens:?} at {v}");
        }
    }
}

fn grid(lens: Lens, focal_px: f64) -> Result<LensGrid, LensError> {
    let center = DVec2::new(320.0, 240.0);
    LensGrid::new(lens, DVec2::splat(focal_px), center, [640, 480])
}

#[test]
fn a_grid_is_near_everywhere_and_its_extent_holds_the_picture() {
    for (lens, _) in OPENCV {
        let grid = grid(lens, 400.0).unwrap();
        let p = lens.polynomial();
        let [low, high] = grid.extent();
        for (x, y) in [(0.0, 0.0), (640.0, 480.0), (320.5, 3.2), (633.0, 479.9), (17.3, 222.2)] {
            let distorted = (DVec2::new(x, y) - DVec2::new(320.0, 240.0)) / 400.0;
            let v = p.solve(distorted).unwrap();
            assert!(v.distance(grid.near(x, y)) * 400.0 < 0.2, "{lens:?} at {x}, {y}");
            let u = lens.undistort(distorted).unwrap();
            assert!(u.cmpge(low - 1e-12).all() && u.cmple(high + 1e-12).all(), "{lens:?}: {u}");
        }
    }
    assert!(grid(CUSHION, 400.0).unwrap().magnification() > 1.1);
    assert_eq!(grid(EQUIDISTANT, 400.0).unwrap().magnification(), 1.0);
}

#[test]
fn pictures_that_fold_over_or_see_too_far_are_refused() {
    let folding = Lens::Brown { k1: -0.5, k2: 0.0, p1: 0.0, p2: 0.0, k3: 0.0 };
    assert!(grid(folding, 1000.0).is_ok());
    let error = grid(folding, 400.0).unwrap_err();
    assert!(matches!(error, LensError::Folds { .. }), "{error}");
    // A radius of 400 px at 280 px a radian is 81.9 degrees.
    let error = grid(EQUIDISTANT, 280.0).unwrap_err();
    assert!(matches!(error, LensError::TooWide { angle_deg, .. } if angle_deg > 80.0), "{error}");
    assert!(grid(EQUIDISTANT, 287.0).is_ok());
}

#[test]
fn what_a_polynomial_brings_back_is_not_reached() {
    let folding = Lens::Brown { k1: -0.3, k2: 0.0, p1: 0.0, p2: 0.0, k3: 0.0 };
    let far = DVec2::new(1.7, 0.0);
    assert!(folding.distort(far).length() < 0.3, "it looks as if in the picture");
    assert!(!folding.reaches(far));
    assert!(folding.reaches(DVec2::new(0.9, 0.3)));
    assert!(EQUIDISTANT.reaches(DVec2::new(50.0, 3.0)));
}
