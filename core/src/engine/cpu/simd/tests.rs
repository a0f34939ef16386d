//! Both forms of every operation give the same bits.

use std::sync::atomic::AtomicU32;

use super::*;

#[test]
fn rounding_and_floor_are_exact_on_both_sides_of_zero() {
    let v = F32x8::<false>([-2.5, -1.0, -0.25, 0.0, 0.25, 1.75, 4_000_000.0, -4_000_000.0]);
    assert_eq!(v.floor().0, [-3.0, -1.0, -1.0, 0.0, 0.0, 1.0, 4_000_000.0, -4_000_000.0]);
    assert_eq!(v.round_i32().0, [-2, -1, 0, 0, 0, 2, 4_000_000, -4_000_000]);
}

#[test]
fn clamping_turns_nan_into_the_lower_bound() {
    assert_eq!(F32x8::<false>::splat(f32::NAN).clamp(0.0, 1.0), F32x8::ZERO);
}

#[test]
fn smallest_and_largest_look_at_every_lane() {
    for lane in 0..LANES {
        let mut v = [0.5; LANES];
        v[lane] = -3.0;
        assert_eq!(F32x8::<false>(v).smallest(), -3.0);
        v[lane] = 7.0;
        assert_eq!(F32x8::<false>(v).largest(), 7.0);
    }
}

kernel! {
    /// The bits that every operation makes of two vectors.
    fn every_operation(a: [f32; LANES], b: [f32; LANES], out: &mut Vec<[u32; LANES]>)
        = every_operation_body
}

#[inline(always)]
fn every_operation_body<const AVX2: bool>(
    a: [f32; LANES],
    b: [f32; LANES],
    out: &mut Vec<[u32; LANES]>,
) {
    let (a, b) = (F32x8::<AVX2>(a), F32x8::<AVX2>(b));
    for v in [a + b, a - b, a * b, a / b, -a, a.min(b), a.max(b), a.sqrt(), a.floor()] {
        out.push(v.0.map(f32::to_bits));
    }
    let (mask, other) = (a.gt(b), a.ge(b));
    out.push(mask.select(a, b).0.map(f32::to_bits));
    out.push((mask | other).select(a, b).0.map(f32::to_bits));
    out.push((mask & other).select_u32(7, [9; LANES]));
    out.push([u32::from(mask.any()); LANES]);
    for v in [(a * a + F32x8::splat(1e-9)).log2(), b.exp2(), (a * a + F32x8::ONE).powf(0.7)] {
        out.push(v.0.map(f32::to_bits));
    }
    out.push([a.smallest().to_bits(); LANES]);
    out.push([a.largest().to_bits(); LANES]);
    let (i, j) = (a.round_i32(), b.to_bits());
    let integers = [i, j, i + j, i - j, i * j, i & j, i | j, j << 5, j >> 7, i.shl_each(j >> 20)];
    out.extend(integers.map(|v| v.0.map(|lane| lane as u32)));
    out.extend([i.min(j), i.max(j)].map(|v| v.0.map(|lane| lane as u32)));
    out.push(mask.select_i32(i, j).0.map(|lane| lane as u32));
    out.push([mask.bits(), other.bits(), i.eq(j).bits(), i.eq(i).bits(), 0, 0, 0, 0]);
    let pairs = std::array::from_fn(|lane| [i.0[lane], j.0[lane]]);
    out.extend(unzipped::<AVX2>(pairs).map(|v| v.0.map(|lane| lane as u32)));
    out.push(i.to_f32().0.map(f32::to_bits));
    let table: Vec<u32> = (0..1000).map(|v| v * v).collect();
    out.push(i.gather_u32(&table).0.map(|lane| lane as u32));
    let shared: Vec<AtomicU32> =
        table.iter().map(|v| AtomicU32::new((*v as f32).to_bits())).collect();
    out.push(j.gather_shared_f32(&shared).0.map(f32::to_bits));
    out.push((j >> 22).gather_shared_f32(&shared).0.map(f32::to_bits));
    out.push(i.gt(j).select(a, b).0.map(f32::to_bits));
    let table: Vec<u32> = (0..1000).map(|v| v * v + 3).collect();
    out.extend(i.gather_pairs(&table).map(|v| v.0.map(|lane| lane as u32)));
    out.extend((j >> 22).gather_pairs(&table).map(|v| v.0.map(|lane| lane as u32)));
    let rows = std::array::from_fn(|row| a.0.map(|v| v + row as f32));
    out.extend(transposed::<AVX2>(rows).map(|v| v.0.map(f32::to_bits)));
}

#[test]
fn both_forms_of_every_operation_give_the_same_bits() {
    let odd = [0.0, -0.0, 1.5, -2.25, 1e30, -1e-30, 4e6, 0.1];
    for turn in 0..LANES {
        let mut other = odd;
        other.rotate_left(turn);
        let (mut plain, mut best) = (Vec::new(), Vec::new());
        every_operation(Level::BASELINE, odd, other, &mut plain);
        every_operation(Level::detect(), odd, other, &mut best);
        for (operation, (a, b)) in plain.iter().zip(&best).enumerate() {
            for lane in 0..LANES {
                let both_nan = f32::from_bits(a[lane]).is_nan() && f32::from_bits(b[lane]).is_nan();
                assert!(a[lane] == b[lane] || both_nan, "operation {operation}, lane {lane}");
            }
        }
    }
}
