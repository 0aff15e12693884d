//! Links tightened to a force in a static stage, then locked at their length.

use crate::data::{LinkKind, Load};
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::span;
use base::math::Vec3;
use base::names::short;
use deck::links as words;
use mechanics::elements::link::LinkLaw;

/// The pretension of a link in one stage.
pub struct Pretension {
    force: f64,
    /// The amplitude of the force in the stage of tightening (`None` for the default of loads); otherwise the length is locked.
    pulls: Option<Option<usize>>,
}

impl Pretension {
    /// The force on the take-up node; `None` for a locked length.
    pub fn pull(&self, node: usize) -> Option<Load> {
        self.pulls.map(|amplitude| Load {
            node,
            force: Vec3::new(self.force, 0.0, 0.0),
            moment: Vec3::zeros(),
            follower: false,
            amplitude,
            origin: None,
            moment_counts: true,
        })
    }
}

/// Reads the pretension of a link; `None` where it has none.
pub fn pretension<'d>(
    owner: &Owner<'d>,
    link: &'d words::Link,
    kind: Option<&LinkKind>,
    scene: &Scene<'d>,
    report: &mut Report<'d>,
) -> Option<Pretension> {
    let force = link.pretension.as_ref()?;
    let mut wrong = |message: &str, hint: &str| report.error_with::<()>(&force.span, message, hint);
    match kind {
        Some(LinkKind::Line { law: LinkLaw::CompressionOnly { .. }, .. }) => {
            wrong(
                "a link that is \"compression-only\" cannot be pulled",
                "a `linear` link or a `tension-only` one can",
            );
        }
        Some(LinkKind::Line { law: LinkLaw::TensionOnly { gap, .. }, .. }) if *gap > 0.0 => {
            wrong(
                "a link with a `gap` cannot be pretensioned",
                "remove the gap: rdsolve finds the slack that the bolt takes up",
            );
        }
        Some(LinkKind::Line { law: LinkLaw::TensionOnly { .. }, .. }) if force.value < 0.0 => {
            wrong("a link that is \"tension-only\" needs a `pretension` above 0", "a `linear` link can be pushed");
        }
        Some(LinkKind::Line { law: LinkLaw::Linear { stiffness: 0.0, .. }, .. }) => {
            wrong("a link without stiffness cannot be pretensioned", "give it `stiffness`");
        }
        Some(LinkKind::Hysteretic { .. } | LinkKind::Isolator { .. }) => {
            wrong("a link that remembers cannot be pretensioned", "put a link with `pretension` beside it");
        }
        Some(LinkKind::Bushing { .. } | LinkKind::Bearing { .. }) => {
            wrong("a bushing cannot be pretensioned", "put a link with `pretension` beside it");
        }
        _ if force.value == 0.0 => {
            wrong("`pretension` must not be 0", "leave it out");
        }
        _ => {}
    }
    if let (Some(preload), Some(_)) = (span(&link.preload), &link.pretension) {
        report.error_with::<()>(
            preload,
            "a link has `preload` or `pretension`",
            "one pulls from t = 0 on, the other is reached",
        );
    }
    if force.value < 0.0 {
        let hint = format!("for a bolt write {}; a strut may have it", short(-force.value));
        report.note(&force.span, "this `pretension` is negative: it pushes the ends apart", hint);
    }
    pulls(owner, link, scene, report).map(|pulls| Pretension { force: force.value, pulls })
}

/// Whether the stage pulls, with the amplitude of the force. A link that comes when nothing can pull it is an error.
fn pulls<'d>(
    owner: &Owner<'d>,
    link: &'d words::Link,
    scene: &Scene<'d>,
    report: &mut Report<'d>,
) -> Option<Option<Option<usize>>> {
    let place = span(&link.pretension).unwrap_or(owner.span);
    let needs = "`pretension` needs a static stage, the first with this link";
    let hint = "`[[stages]]` of kind \"static\" pull it, or give `preload`, the force at zero elongation";
    let Some(stage) = scene.stage else {
        return match scene.analysis.is_static() {
            true => Some(Some(None)),
            false => report.error_with(place, needs, hint),
        };
    };
    if !stage.begins_pulling(&link.stages) {
        return report.error_with(place, needs, hint);
    }
    if !stage.is_there_once(&link.stages) {
        let message = format!("{} goes and comes back, and so cannot keep its length", owner.what);
        return report.error_with(place, message, "name its `stages` without a break");
    }
    Some(stage.is_pulled(&link.stages).then(|| Some(stage.own_amplitude(&link.stages))))
}
