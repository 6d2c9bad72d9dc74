//! Scenes of solids.

use crate::{
    bounds::LENGTH,
    contact::{RELATIVE_TOLERANCE, overlapping_pieces},
    error::SceneError,
    geometry::{PoseInSpace, Shape, Solid, SolidFault, Vector3},
    scene::{Body, BodyOptions, SceneOf, coordinates, within_reach},
};

/// Blocks under gravity in space.
pub type SceneInSpace = SceneOf<Solid>;

impl Body<Solid> {
    /// Every corner in the world, metres, piece by piece.
    pub fn corners(&self) -> Vec<[f64; 3]> {
        self.shape.vertices().map(|v| self.pose.transform(v).to_array()).collect()
    }
}

impl SceneInSpace {
    /// Adds a cuboid with the given centre and sides. The pose's orientation need not have length one. Returns the
    /// block's index.
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn add_cuboid(&mut self, pose: PoseInSpace, size: [f64; 3], options: BodyOptions) -> Result<usize, SceneError> {
        let name = self.free_name(&options)?;
        let pose = checked(&name, "center", pose)?;
        for (axis, &side) in size.iter().enumerate() {
            LENGTH.check_positive(format_args!("block \"{name}\": size[{axis}]"), side)?;
        }
        let shape = Solid::cuboid(size);
        match options.own.checked_center(&name)? {
            None | Some([0.0, 0.0, 0.0]) => self.push(name, shape, Some(size), pose, options.about_centroid()),
            Some(own) => {
                let corners = shape.vertices().map(|v| v.to_array()).collect();
                self.push_about(name, &[corners], pose, own, options)
            }
        }
    }

    /// Adds one rigid block of convex pieces: the hull of each list of points in a frame, metres. The body's own frame
    /// keeps the orientation and moves its origin to the centre of mass. Pieces of a block may overlap if it is fixed or its
    /// mass is given. Returns the block's index.
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn add_solid(
        &mut self,
        pieces: &[Vec<[f64; 3]>],
        frame: PoseInSpace,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let name = self.free_name(&options)?;
        let frame = checked(&name, "position", frame)?;
        pieces.iter().try_for_each(|piece| within_reach(&name, piece))?;
        if let Some(own) = options.own.checked_center(&name)? {
            return self.push_about(name, pieces, frame, own, options);
        }
        let bad = |fault: SolidFault| SceneError::BadSolid { body: name.clone(), fault };
        let (solid, centroid) = Solid::from_pieces(pieces).map_err(bad)?;
        self.push_solid(name, solid, frame, centroid, options)
    }

    /// Adds one rigid block within a closed surface: vertices in a frame, metres, and triangles, counter-clockwise from outside.
    /// It may be concave, curved and large, and is not cut into convex pieces. The body's own frame keeps the orientation and moves
    /// its origin to the centre of mass. Returns the block's index.
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn add_surface(
        &mut self,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        frame: PoseInSpace,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let (solid, center) = self.enclosed(vertices, triangles, &options)?;
        self.add_enclosed(solid, center, frame, options)
    }

    /// What [`Self::add_surface`] would add, which takes long for a large surface, and where its origin is in the frame.
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn enclosed(
        &self,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        options: &BodyOptions,
    ) -> Result<(Solid, [f64; 3]), SceneError> {
        let name = self.free_name(options)?;
        within_reach(&name, vertices)?;
        let bad = |fault: SolidFault| SceneError::BadSolid { body: name.clone(), fault };
        match options.own.checked_center(&name)? {
            Some(own) => Ok((Solid::surface_about(vertices, triangles, own).map_err(bad)?, own)),
            None => Solid::from_surface(vertices, triangles).map_err(bad),
        }
    }

    /// Adds what [`Self::enclosed`] made with the same options.
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn add_enclosed(
        &mut self,
        solid: Solid,
        center: [f64; 3],
        frame: PoseInSpace,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let name = self.free_name(&options)?;
        let frame = checked(&name, "position", frame)?;
        self.push_solid(name, solid, frame, center, options)
    }

    /// Adds a solid with a centre of mass of its own; both are given in the frame.
    fn push_about(
        &mut self,
        name: String,
        pieces: &[Vec<[f64; 3]>],
        frame: PoseInSpace,
        own: [f64; 3],
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let bad = |fault: SolidFault| SceneError::BadSolid { body: name.clone(), fault };
        let solid = Solid::about(pieces, own).map_err(bad)?;
        self.push_solid(name, solid, frame, own, options)
    }

    /// Adds a solid whose origin is at `center` of the frame. Its pieces may overlap if its mass does not come from them.
    fn push_solid(
        &mut self,
        name: String,
        solid: Solid,
        frame: PoseInSpace,
        center: [f64; 3],
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        if options.own.mass.is_none() && !options.fixed {
            let tolerance = self.contact_tolerance().unwrap_or(RELATIVE_TOLERANCE * solid.width());
            if let Some(([first, second], depth)) = overlapping_pieces(&solid, tolerance) {
                let fault = SolidFault::PiecesOverlap { first, second, depth };
                return Err(SceneError::BadSolid { body: name, fault });
            }
        }
        let position = frame.transform(Vector3::from_array(center)).to_array();
        self.push(name, solid, None, PoseInSpace { position, ..frame }, options)
    }
}

/// A pose of finite numbers, its quaternion scaled to length one.
fn checked(name: &str, place: &str, pose: PoseInSpace) -> Result<PoseInSpace, SceneError> {
    coordinates(format_args!("block \"{name}\": {place}"), &pose.position)?;
    if let Some(k) = pose.orientation.iter().position(|q| !q.is_finite()) {
        let place = format!("block \"{name}\": orientation[{k}]");
        return Err(SceneError::NotFinite { place, value: pose.orientation[k] });
    }
    let largest = pose.orientation.iter().fold(0.0, |largest: f64, q| largest.max(q.abs()));
    if largest == 0.0 {
        return Err(SceneError::ZeroOrientation { body: name.to_owned() });
    }
    // Squares of other numbers may be none.
    let scale = if (1e-100..1e100).contains(&largest) { 1.0 } else { largest };
    let orientation = pose.orientation.map(|q| q / scale);
    let length = orientation.iter().map(|q| q * q).sum::<f64>().sqrt();
    // Within rounding of one it stays as it is, so that a stored orientation comes back bit for bit.
    let unit = if (length - 1.0).abs() <= 4.0 * f64::EPSILON { 1.0 } else { length };
    Ok(PoseInSpace { orientation: orientation.map(|q| q / unit), ..pose })
}
