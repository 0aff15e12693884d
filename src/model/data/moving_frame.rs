//! Reference frames of parts, moved by supports.

use base::math::Vec3;

/// A frame with the velocity of nodes moved by supports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingFrame {
    /// For each global direction the node with the frame's translation; `None` for a frame at rest.
    pub translation: [Option<usize>; 3],
    /// The centre node of its rotation and the active components of that node's rotation; `None` without rotation.
    pub rotation: Option<(usize, [bool; 3])>,
}

impl MovingFrame {
    /// The linear and angular velocity of the frame at a place, from those of nodes and from the places of nodes.
    pub fn velocity(&self, of: impl Fn(usize) -> [Vec3; 2], at: impl Fn(usize) -> Vec3, x: &Vec3) -> [Vec3; 2] {
        let v = Vec3::from_fn(|dof, _| self.translation[dof].map_or(0.0, |node| of(node)[0][dof]));
        match self.rotation {
            None => [v, Vec3::zeros()],
            Some((node, turns)) => {
                let omega = Vec3::from_fn(|dof, _| if turns[dof] { of(node)[1][dof] } else { 0.0 });
                [v + omega.cross(&(x - at(node))), omega]
            }
        }
    }
}

/// The frames of a scene.
#[derive(Debug, Clone, Default)]
pub struct MovingFrames {
    /// The frames.
    pub list: Vec<MovingFrame>,
    /// For each node the place of its frame in the list, [`MovingFrames::NONE`] where it stands on the ground; empty without frames.
    pub of_node: Vec<u32>,
}

impl MovingFrames {
    /// The place of no frame.
    pub const NONE: u32 = u32::MAX;

    /// The frame of a node; `None` where it stands on the ground.
    #[inline]
    pub fn of(&self, node: usize) -> Option<&MovingFrame> {
        self.of_node.get(node).and_then(|&place| self.list.get(place as usize))
    }

    /// True where all stands on the ground.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}
