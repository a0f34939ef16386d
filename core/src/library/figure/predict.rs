//! Prediction of a vertex's displacement from vertices that stand before it.
//!
//! Shapes vary smoothly over the body, so what differs from the mean of three near vertices is
//! small and packs well. Exact in integers: decoding gives back every bit.

/// Vertices that predict one vertex.
pub const PARENTS: usize = 3;
/// Weights are in units of 1/16 and sum to 16, or are all 0 where nothing predicts.
const SHIFT: u32 = 4;

fn predicted(run: &[i16], parents: &[u16], weights: &[u8]) -> i16 {
    let sum: i32 = parents
        .iter()
        .zip(weights)
        .map(|(&p, &w)| i32::from(w) * i32::from(run[usize::from(p)]))
        .sum();
    ((sum + (1 << (SHIFT - 1))) >> SHIFT) as i16
}

/// Replaces deltas by what differs from the prediction, in runs of one number per vertex.
pub fn encode(deltas: &mut [i16], parents: &[u16], weights: &[u8]) {
    let n = (parents.len() / PARENTS).max(1);
    for run in deltas.chunks_mut(n) {
        // Backwards, because predictions need the true values of earlier vertices.
        for v in (0..run.len()).rev() {
            let range = v * PARENTS..(v + 1) * PARENTS;
            run[v] = run[v].wrapping_sub(predicted(run, &parents[range.clone()], &weights[range]));
        }
    }
}

/// Undoes [`encode`].
pub fn decode(residuals: &mut [i16], parents: &[u16], weights: &[u8]) {
    let n = (parents.len() / PARENTS).max(1);
    for run in residuals.chunks_mut(n) {
        for v in 0..run.len() {
            let range = v * PARENTS..(v + 1) * PARENTS;
            run[v] = run[v].wrapping_add(predicted(run, &parents[range.clone()], &weights[range]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decoding_undoes_encoding_to_the_bit() {
        let parents = [0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 1, 0];
        let weights = [0, 0, 0, 16, 0, 0, 7, 9, 0, 5, 5, 6];
        let deltas = [5i16, -7, 30_000, -12, i16::MAX, i16::MIN, 3, 4];
        let mut coded = deltas;
        encode(&mut coded, &parents, &weights);
        assert_ne!(coded, deltas);
        decode(&mut coded, &parents, &weights);
        assert_eq!(coded, deltas);
    }
}
