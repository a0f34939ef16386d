// Numbers of some 44 binary digits as sums of two (Dekker 1971; Knuth, TAOCP 2, 4.2.2), for what
// the native engine does in f64. Products are sums of products of half-width parts, which are
// exact with and without fused multiply-add; what must not be reordered passes `opaque`.

struct Double {
    hi: f32,
    lo: f32,
}

// The number itself, in a way that no compiler can see through.
fn opaque(v: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(v) ^ frame.zero);
}

fn two_sum(a: f32, b: f32) -> Double {
    let sum = opaque(a + b);
    let part = opaque(sum - a);
    return Double(sum, (a - (sum - part)) + (b - part));
}

// As two_sum where |a| >= |b|.
fn quick_sum(a: f32, b: f32) -> Double {
    let sum = opaque(a + b);
    return Double(sum, b - (sum - a));
}

fn high_part(v: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(v) & 0xfffff000u);
}

fn two_product(a: f32, b: f32) -> Double {
    let ah = high_part(a);
    let bh = high_part(b);
    let al = a - ah;
    let bl = b - bh;
    return two_sum(ah * bh, (ah * bl + al * bh) + al * bl);
}

fn double(v: f32) -> Double {
    return Double(v, 0.0);
}

fn add_double(a: Double, b: Double) -> Double {
    let sum = two_sum(a.hi, b.hi);
    return quick_sum(sum.hi, sum.lo + (a.lo + b.lo));
}

fn negated(a: Double) -> Double {
    return Double(-a.hi, -a.lo);
}

fn multiply_double(a: Double, b: Double) -> Double {
    let product = two_product(a.hi, b.hi);
    return quick_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

fn divide_double(a: Double, b: Double) -> Double {
    let first = a.hi / b.hi;
    let rest = add_double(a, negated(multiply_double(double(first), b)));
    return quick_sum(first, rest.hi / b.hi);
}

fn between_doubles(a: Double, b: Double, t: Double) -> Double {
    return add_double(a, multiply_double(add_double(b, negated(a)), t));
}

// The nearest whole number, for magnitudes below 2^31.
fn round_double(v: Double) -> i32 {
    let whole = floor(v.hi);
    return i32(whole) + i32(floor((v.hi - whole) + v.lo + 0.5));
}
