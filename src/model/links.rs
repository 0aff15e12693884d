//! `[[links]]`: their ends and laws.

use super::build::{Builder, Owner, span, vec3};
use super::{Held, Link, LinkKind};
use crate::deck::links as deck;
use crate::deck::words::{Maybe, Numbers, Table};
use crate::diagnostic::{At, Diagnostic, Span};
use crate::elements::link::Law;
use crate::math::{Mat3, Vec3};

impl<'d> Builder<'d> {
    pub fn links(&mut self) {
        for (index, link) in self.deck.links.iter().enumerate() {
            let name = link.name.as_ref().map_or_else(|| format!("links.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("link `{name}`"), span: &link.span };
            self.need(&owner, "name", &link.name);
            let rotations = link.bushing.is_some();
            let from = self.end(&owner, "from", &link.from, &name, rotations, None);
            let to = self.end(&owner, "to", &link.to, &name, rotations, None);
            let ends = from.zip(to).map(|(from, to)| [from, to]);
            let kind = if link.bushing.is_some() { self.bushing(link) } else { self.line(&owner, link, ends) };
            if let Some([from, to]) = ends
                && from == to
            {
                self.error::<()>(
                    owner.span,
                    format!("{} joins `{}` to itself", owner.what, self.model.nodes[from].label),
                );
            }
            if let (Some(ends), Some(kind)) = (ends, kind) {
                self.model.add(Link { name, ends, kind });
            }
        }
    }

    /// The node at an end: a point's own, or a new one on a body or on the ground. `place`: where on a body, if not its centre,
    /// when nothing is said.
    pub fn end(
        &mut self,
        owner: &Owner<'d>,
        key: &str,
        end: &'d Maybe<Table<deck::End>>,
        name: &str,
        rotations: bool,
        place: Option<Vec3>,
    ) -> Option<usize> {
        let end = self.need(owner, key, end)?;
        let label = format!("{name}.{key}");
        let node = match (&end.node, &end.body, &end.ground) {
            (Some(point), None, None) => {
                self.stray("an end on a point", &[("point", span(&end.point))]);
                self.point("node", point)?
            }
            (None, Some(body), None) => {
                let master = self.body(body)?;
                let master = self.model.bodies[master].node;
                match &end.point {
                    Some(point) if vec3(point) != self.x(master) => self.rider(label, vec3(point), master, &point.span),
                    _ if self.is_spoiled(&end.span, "point") => return None,
                    None if place.is_some_and(|place| place != self.x(master)) => {
                        self.rider(label, place.unwrap_or_default(), master, &end.span)
                    }
                    _ => master,
                }
            }
            (None, None, Some(ground)) => {
                self.stray("an end on the ground", &[("point", span(&end.point))]);
                let node = self.node(label, false, vec3(ground));
                for dof in 0..6 {
                    self.held.insert((node, dof), (Held { node, dof, motion: None }, ground.span.clone()));
                }
                node
            }
            (None, None, None) if self.deck.spoiled.iter().any(|entry| entry.table.as_ref() == Some(&end.span)) => {
                return None;
            }
            _ => {
                let message = format!("`{key}` of {} must lie on one of a node, a body and the ground", owner.what);
                let hint = "{ node = \"name\" }, { body = \"name\", point = [x, y, z] } or { ground = [x, y, z] }";
                self.problems.push(Diagnostic::error(message).at(&end.span).hint("say which").hint(hint));
                return None;
            }
        };
        self.touch(node, rotations);
        Some(node)
    }

    fn line(&mut self, owner: &Owner<'d>, link: &'d deck::Link, ends: Option<[usize; 2]>) -> Option<LinkKind> {
        let strays = [("bushing_damping", span(&link.bushing_damping)), ("axes", span(&link.axes))];
        self.stray("a link without `bushing`", &strays);
        let law = self.law(owner, link);
        let damping = self.not_negative("damping", &link.damping, 0.0);
        let free_length = link.free_length.as_ref().map(|length| length.value);
        let direction = match &link.direction {
            Some(direction) => Some(self.unit("direction", direction)?),
            None if self.is_spoiled(owner.span, "direction") => return None,
            None => {
                self.not_negative("free_length", &link.free_length, 0.0);
                None
            }
        };
        let arm = ends.map(|[from, to]| self.x(to) - self.x(from))?;
        let initial = match direction {
            Some(direction) => direction.dot(&arm),
            None if arm.norm() == 0.0 => {
                let message =
                    format!("the ends of {} lie at the same place, so there is no line between them", owner.what);
                return self.error_with(owner.span, message, "give it a `direction`, from `from` to `to`");
            }
            None => arm.norm(),
        };
        let law = law?;
        Some(LinkKind::Line { law, damping, direction, free_length: free_length.unwrap_or(initial) })
    }

    fn law(&mut self, owner: &Owner<'d>, link: &'d deck::Link) -> Option<Law> {
        let law = match &link.law {
            Some(law) => law.value,
            None if self.is_spoiled(owner.span, "law") => return None,
            None => deck::Law::Linear,
        };
        let [stiffness, gap] = [("stiffness", span(&link.stiffness)), ("gap", span(&link.gap))];
        let [preload, points] = [("preload", span(&link.preload)), ("points", span(&link.points))];
        match law {
            deck::Law::Linear => {
                self.stray("the law \"linear\"", &[gap, points]);
                if link.damping.is_none() {
                    self.need(owner, "stiffness", &link.stiffness)?;
                }
                let stiffness = self.not_negative("stiffness", &link.stiffness, 0.0);
                Some(Law::Linear { stiffness, preload: link.preload.as_ref().map_or(0.0, |force| force.value) })
            }
            deck::Law::Table => {
                self.stray("the law \"table\"", &[stiffness, gap, preload]);
                let points = self.need(owner, "points", &link.points)?;
                self.rising("elongation", points).map(|points| Law::Table { points })
            }
            deck::Law::CompressionOnly | deck::Law::TensionOnly => {
                let one_sided = "a law that acts one way only";
                self.stray(one_sided, &[preload, points]);
                let stiffness = self.need_positive(owner, "stiffness", &link.stiffness);
                let gap = self.not_negative("gap", &link.gap, 0.0);
                let stiffness = stiffness?;
                Some(match law {
                    deck::Law::CompressionOnly => Law::CompressionOnly { stiffness, gap },
                    _ => Law::TensionOnly { stiffness, gap },
                })
            }
        }
    }

    /// Two points or more whose first numbers increase.
    pub fn rising(&mut self, what: &str, points: &At<Vec<At<Numbers<2>>>>) -> Option<Vec<[f64; 2]>> {
        if points.len() < 2 {
            return self.error(&points.span, "`points` needs two points or more");
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0[0] <= pair[0].0[0]) {
            let message = format!("`points` must go up in {what}");
            return self.error_with(&pair[1].span, message, format!("the one before is at {}", pair[0].0[0]));
        }
        Some(points.iter().map(|point| point.0).collect())
    }

    fn bushing(&mut self, link: &'d deck::Link) -> Option<LinkKind> {
        let strays = [
            ("law", span(&link.law)),
            ("stiffness", span(&link.stiffness)),
            ("damping", span(&link.damping)),
            ("gap", span(&link.gap)),
            ("preload", span(&link.preload)),
            ("free_length", span(&link.free_length)),
            ("direction", span(&link.direction)),
            ("points", span(&link.points)),
        ];
        self.stray("a bushing", &strays);
        let stiffness = self.six("bushing", &link.bushing);
        let damping = self.six("bushing_damping", &link.bushing_damping);
        let axes = match &link.axes {
            Some(axes) => self.axes(axes)?,
            None => Mat3::identity(),
        };
        Some(LinkKind::Bushing { stiffness: stiffness?, damping: damping?, axes })
    }

    fn six(&mut self, key: &str, values: &Maybe<Numbers<6>>) -> Option<[f64; 6]> {
        match values {
            Some(values) if values.0.iter().any(|&value| value < 0.0) => {
                self.error(&values.span, format!("the values of `{key}` must not be negative"))
            }
            Some(values) => Some(values.0),
            None => Some([0.0; 6]),
        }
    }

    pub fn axes(&mut self, axes: &At<Vec<Numbers<3>>>) -> Option<Mat3> {
        let place: &Span = &axes.span;
        let [x, y] = axes.as_slice() else {
            return self.error_with(place, "`axes` takes two vectors", "x, and a vector in the x-y plane");
        };
        let unit = |v: &Numbers<3>| Vec3::from(v.0).try_normalize(0.0);
        let z = unit(x).zip(unit(y)).and_then(|(x, y)| x.cross(&y).try_normalize(1e-6));
        let Some((x, z)) = unit(x).zip(z) else {
            return self.error(place, "the two vectors of `axes` must be neither zero nor parallel");
        };
        Some(Mat3::from_columns(&[x, z.cross(&x), z]))
    }
}
