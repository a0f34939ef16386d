//! The backward walk from wanted outputs to the passes that must run.

use std::collections::BTreeSet;

use super::{Buffer, Outputs, Pass};

/// What a scene does or does not hold, to shorten a plan further.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneFacts {
    /// A sun that casts shadows is on.
    pub sun_shadow: bool,
    /// The camera has a depth of field.
    pub defocus: bool,
    /// The shutter is open for a while.
    pub motion: bool,
    /// The lens scatters light.
    pub bloom: bool,
}

impl SceneFacts {
    /// Where nothing is known, everything may be there.
    pub const ANY: Self = Self { sun_shadow: true, defocus: true, motion: true, bloom: true };

    /// Why a scene does without a pass that its outputs would take.
    const fn skip(self, pass: Pass) -> Option<Skipped> {
        match pass {
            Pass::Shadow if !self.sun_shadow => Some(Skipped::NoSunShadow),
            Pass::Defocus if !self.defocus => Some(Skipped::InFocus),
            Pass::MotionBlur if !self.motion => Some(Skipped::Still),
            Pass::Bloom if !self.bloom => Some(Skipped::NoBloom),
            _ => None,
        }
    }
}

/// Why a pass does not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skipped {
    /// No wanted output needs what it writes.
    NotWanted,
    /// No sun casts a shadow.
    NoSunShadow,
    /// Nothing that is seen is out of focus.
    InFocus,
    /// Nothing that is seen moves while the shutter is open.
    Still,
    /// The lens scatters no light.
    NoBloom,
}

/// Where the picture is wanted. Labels are always read back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Delivery {
    /// In the frame that the engine hands back.
    #[default]
    Readback,
    /// On the device that renders, where somebody shows it; in the frame if the engine has no
    /// device that anybody could show it on.
    Texture,
}

/// The passes that run, in order, and why the others do not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassPlan {
    passes: Vec<Pass>,
    skipped: Vec<(Pass, Skipped)>,
    delivery: Delivery,
}

impl PassPlan {
    /// The smallest plan that yields the outputs.
    #[must_use]
    pub fn new(wanted: &Outputs, facts: SceneFacts) -> Self {
        let mut buffers: BTreeSet<Buffer> =
            wanted.iter().flat_map(|o| o.needs()).copied().collect();
        let (mut passes, mut skipped) = (Vec::new(), Vec::new());
        for pass in Pass::ALL.into_iter().rev() {
            if !pass.writes().iter().any(|b| buffers.contains(b)) {
                skipped.push((pass, Skipped::NotWanted));
            } else if let Some(why) = facts.skip(pass) {
                skipped.push((pass, why));
            } else {
                passes.push(pass);
                buffers.extend(pass.reads());
            }
        }
        passes.reverse();
        skipped.reverse();
        Self { passes, skipped, delivery: Delivery::Readback }
    }

    /// The same plan without a pass, if it has it.
    #[must_use]
    pub fn without(mut self, pass: Pass, why: Skipped) -> Self {
        if self.runs(pass) {
            self.passes.retain(|p| *p != pass);
            let place = self.skipped.iter().take_while(|(p, _)| *p < pass).count();
            self.skipped.insert(place, (pass, why));
        }
        self
    }

    /// The same plan with its picture wanted elsewhere.
    #[must_use]
    pub const fn delivered(mut self, delivery: Delivery) -> Self {
        self.delivery = delivery;
        self
    }

    /// Where the picture is wanted.
    #[must_use]
    pub const fn delivery(&self) -> Delivery {
        self.delivery
    }

    /// The passes that run, in execution order.
    #[must_use]
    pub fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// Whether a pass runs.
    #[must_use]
    pub fn runs(&self, pass: Pass) -> bool {
        self.passes.contains(&pass)
    }

    /// The passes that do not run, each with its reason.
    #[must_use]
    pub fn skipped(&self) -> &[(Pass, Skipped)] {
        &self.skipped
    }

    /// Whether an engine has anything to do; keypoints alone are posed on the host.
    #[must_use]
    pub fn needs_engine(&self) -> bool {
        self.runs(Pass::Visibility)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Output;

    const LIT: SceneFacts = SceneFacts::ANY;

    fn all_wishes() -> impl Iterator<Item = Outputs> {
        (0..1u32 << Output::ALL.len()).map(|bits| {
            let chosen = |i: &usize| bits >> i & 1 == 1;
            (0..Output::ALL.len()).filter(chosen).map(|i| Output::ALL[i]).collect()
        })
    }

    #[test]
    fn every_wish_gives_a_complete_ordered_and_minimal_plan() {
        for wish in all_wishes() {
            let plan = PassPlan::new(&wish, LIT);
            let mut have = BTreeSet::new();
            for pass in plan.passes() {
                assert!(
                    pass.reads().iter().all(|b| have.contains(b)),
                    "{wish:?}: {pass:?} reads too early"
                );
                have.extend(pass.writes().iter().copied());
            }
            assert!(
                wish.iter().flat_map(|o| o.needs()).all(|b| have.contains(b)),
                "{wish:?} incomplete"
            );
            for (i, pass) in plan.passes().iter().enumerate() {
                let read_later = plan.passes()[i + 1..]
                    .iter()
                    .any(|p| p.reads().iter().any(|b| pass.writes().contains(b)));
                let asked = wish.iter().flat_map(|o| o.needs()).any(|b| pass.writes().contains(b));
                assert!(read_later || asked, "{wish:?}: {pass:?} for nobody");
            }
            assert_eq!(plan.passes().len() + plan.skipped().len(), Pass::ALL.len());
        }
    }

    #[test]
    fn labels_without_a_picture_need_no_shading() {
        let plan = PassPlan::new(&Outputs::from([Output::Box2d, Output::Instance]), LIT);
        assert!(plan.needs_engine());
        let unwanted = [Pass::Shadow, Pass::Shade, Pass::Defocus, Pass::MotionBlur, Pass::Bloom];
        for pass in unwanted.into_iter().chain([Pass::Display, Pass::Points]) {
            assert!(plan.skipped().contains(&(pass, Skipped::NotWanted)), "{pass:?}");
        }
    }

    #[test]
    fn a_sun_that_is_off_costs_no_shadow_map() {
        let plan = PassPlan::new(&Outputs::from([Output::Rgb]), SceneFacts::default());
        assert!(plan.skipped().contains(&(Pass::Shadow, Skipped::NoSunShadow)));
        assert!(plan.runs(Pass::Shade));
    }

    #[test]
    fn a_lens_without_effects_has_no_passes() {
        let rgb = Outputs::from([Output::Rgb]);
        let plan = PassPlan::new(&rgb, SceneFacts::default());
        assert!(plan.skipped().contains(&(Pass::Defocus, Skipped::InFocus)));
        assert!(plan.skipped().contains(&(Pass::MotionBlur, Skipped::Still)));
        assert!(plan.skipped().contains(&(Pass::Bloom, Skipped::NoBloom)));
        let found_out = PassPlan::new(&rgb, SceneFacts { defocus: true, ..SceneFacts::default() });
        assert!(found_out.runs(Pass::Defocus));
        assert_eq!(found_out.without(Pass::Defocus, Skipped::InFocus), plan);
    }
}
