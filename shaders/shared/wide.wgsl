// Whole numbers of 64 bits, for edge functions of triangles larger than some pixels.

struct Wide {
    lo: u32,
    hi: i32,
}

fn multiply_wide(a: i32, b: i32) -> Wide {
    let ua = bitcast<u32>(a);
    let ub = bitcast<u32>(b);
    let a0 = ua & 0xffffu;
    let a1 = ua >> 16u;
    let b0 = ub & 0xffffu;
    let b1 = ub >> 16u;
    let low = a0 * b0;
    let cross0 = a0 * b1;
    let cross1 = a1 * b0;
    let middle = (low >> 16u) + (cross0 & 0xffffu) + (cross1 & 0xffffu);
    let high = a1 * b1 + (cross0 >> 16u) + (cross1 >> 16u) + (middle >> 16u);
    // The product of the bit patterns counts negative numbers as 2^32 more than they are.
    let excess = select(0u, ub, a < 0) + select(0u, ua, b < 0);
    return Wide((low & 0xffffu) | (middle << 16u), bitcast<i32>(high - excess));
}

fn add_wide(a: Wide, b: Wide) -> Wide {
    let lo = a.lo + b.lo;
    return Wide(lo, a.hi + b.hi + select(0, 1, lo < a.lo));
}

fn negate_wide(a: Wide) -> Wide {
    return Wide(~a.lo + 1u, ~a.hi + select(0, 1, a.lo == 0u));
}

fn float_wide(a: Wide) -> f32 {
    var size = a;
    if a.hi < 0 {
        size = negate_wide(a);
    }
    let value = f32(bitcast<u32>(size.hi)) * 4294967296.0 + f32(size.lo);
    return select(value, -value, a.hi < 0);
}

// Rounded down after division by 2^shift, 0 < shift < 32, and kept within 2^30.
fn shift_wide(a: Wide, shift: u32) -> i32 {
    let lo = (a.lo >> shift) | (bitcast<u32>(a.hi) << (32u - shift));
    let hi = a.hi >> shift;
    let limit = select(0x40000000, -0x40000000, hi < 0);
    let fits = (hi == 0 && lo < 0x40000000u) || (hi == -1 && lo >= 0xc0000000u);
    return select(limit, bitcast<i32>(lo), fits);
}
