//! Modes of bodies that joints hold.

use super::{modes, off, omegas};

/// A lever on a hinge with a spring at its end: ω² = k L²/(I + m L²/4), one mode, however it is asked for. The equations of the hinge are
/// regularised by 1e-7, of which the second solution leaves the square.
#[test]
fn lever_on_a_hinge() {
    let text = |analysis: &str| {
        format!(
            "[analysis]\nkind = \"modal\"\n{analysis}\n[[bodies]]\nname = \"lever\"\ncenter = [0.5, 0.0, 0.0]\nmass = 2.0\n\
             inertia = [0.01, 0.2, 0.2]\n[[joints]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n\
             from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"lever\" }}\n[[links]]\nname = \"spring\"\n\
             from = {{ ground = [1.0, 0.0, -0.5] }}\nto = {{ body = \"lever\", point = [1.0, 0.0, 0.0] }}\nstiffness = 1000.0\n"
        )
    };
    let exact = (1000.0f64 / 0.7).sqrt();
    for analysis in ["up_to = 50.0", "up_to = 6.1", "modes = 1", "modes = 4", "modes = 4\ndamped = true"] {
        let found = modes(&text(analysis));
        assert_eq!(found.list.len(), 1, "{analysis}: {:?}", omegas(&found));
        assert!(off(&omegas(&found), &[exact]) < 1e-9, "{analysis}: {:?} {exact}", omegas(&found));
        assert_eq!(found.doubts.len(), usize::from(analysis.contains('4')), "{analysis}: {:?}", found.doubts);
    }
    assert_eq!(modes(&text("up_to = 5.9")).list.len(), 0);
}
