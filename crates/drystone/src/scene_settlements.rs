//! Settlements of supports, said to a scene.

use crate::{
    bounds::{COORDINATE, SMALL_TURN},
    error::SceneError,
    geometry::Shape,
    scene::SceneOf,
    settlement::Settlement,
};

impl<S: Shape> SceneOf<S> {
    /// Prescribes a displacement (metres, world axes) and a turn (radians, about the axes of the world; in the plane the last entry) of
    /// a support. It turns about the point `at` (world coordinates), or about the centroid of its shape. Several settlements of one
    /// support add up.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown block or one that is not fixed, numbers out of bounds.
    pub fn add_settlement(
        &mut self,
        body: &str,
        displacement: S::Vector,
        rotation: [f64; 3],
        at: Option<S::Vector>,
    ) -> Result<(), SceneError> {
        let index = self.index_of(body)?;
        let support = &self.bodies()[index];
        let at = match at {
            None => support.shape.centroid(),
            Some(at) => {
                check(body, "at", at.as_ref())?;
                S::seen_from(&support.pose, at)
            }
        };
        self.push_settlement(index, Settlement { displacement, rotation, at })
    }

    /// The same with the point in the block's frame.
    pub(crate) fn push_settlement(
        &mut self,
        index: usize,
        settlement: Settlement<S::Vector>,
    ) -> Result<(), SceneError> {
        let support = &self.bodies()[index];
        if !support.fixed {
            return Err(SceneError::NotSupport { name: support.name.clone() });
        }
        check(&support.name, "displacement", settlement.displacement.as_ref())?;
        check(&support.name, "at", settlement.at.as_ref())?;
        for (axis, &turn) in settlement.rotation.iter().enumerate() {
            SMALL_TURN.check(format_args!("the settlement of \"{}\": rotation[{axis}]", support.name), turn)?;
        }
        self.settlements_mut(index).push(settlement);
        Ok(())
    }

    /// The same scene with all supports where they are.
    #[must_use]
    pub fn without_settlements(mut self) -> Self {
        (0..self.bodies().len()).for_each(|index| self.settlements_mut(index).clear());
        self
    }

    /// Name of the first support that settles, if one does.
    pub fn settling(&self) -> Option<&str> {
        let settles = self.bodies().iter().find(|body| !body.settlements().is_empty());
        settles.map(|body| body.name.as_str())
    }
}

fn check(body: &str, what: &str, values: &[f64]) -> Result<(), SceneError> {
    let mut numbered = values.iter().enumerate();
    numbered.try_for_each(|(axis, &value)| {
        COORDINATE.check(format_args!("the settlement of \"{body}\": {what}[{axis}]"), value)
    })
}
