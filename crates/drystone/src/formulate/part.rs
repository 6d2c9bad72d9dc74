//! What mechanics needs of a body, whatever the dimension.

use crate::{
    contact::{ContactSet, find_contacts, find_solid_contacts, solid_distance},
    error::SceneError,
    geometry::{Piece, Polygon, Shape, Solid, cross, distance, dot, length, minus},
    scene::{Body, Scene, SceneOf},
};

/// Components of a wrench or a motion on one block: three of force or of translation in world axes, then three of moment or
/// of turning about its principal axes, so that `M^-1` is diagonal. In the plane only x, y and the turn are in use.
pub type Components = [f64; 6];

/// A body without its shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Unique in the scene.
    pub name: String,
    /// Whether it is held in place.
    pub fixed: bool,
    /// Kilograms.
    pub mass: f64,
    /// Principal moments of inertia about the centre of mass, kg m^2.
    pub inertia: [f64; 3],
    /// Unit vectors of the principal axes, in the world.
    pub axes: [[f64; 3]; 3],
    /// The centre of mass in the world, metres.
    pub center: [f64; 3],
    /// Distance of the furthest corner from the centre of mass, metres.
    pub radius: f64,
    /// Wrench of the permanent loads about the centre of mass, N and N m; the weight is not in it.
    pub load: Components,
    /// Small displacement of a support: that of the centre of mass, metres, and the turn about the principal axes, radians.
    pub settlement: Components,
}

/// Shapes of which assemblies are made.
pub trait Assemble: Shape {
    /// Which of the six [`Components`] a block has.
    const COMPONENTS: &'static [usize];

    /// The contacts of a scene of such shapes.
    ///
    /// # Errors
    /// [`SceneError::Overlap`].
    fn contacts(scene: &SceneOf<Self>) -> Result<ContactSet, SceneError>;

    /// A body's mass and place, without loads.
    fn unloaded(body: &Body<Self>) -> Part;

    /// A body's mass, place, loads and settlement.
    fn part(body: &Body<Self>) -> Part {
        let mut part = Self::unloaded(body);
        for load in body.loads() {
            let arm = Self::in_space(Self::turned(&body.pose, load.at));
            let more = part.wrench_and_moment(Self::in_space(load.force), arm, load.moment);
            part.load.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
        for settlement in body.settlements() {
            let arm = Self::in_space(Self::turned(&body.pose, settlement.at));
            let (moved, turned) = (Self::in_space(settlement.displacement), settlement.rotation);
            let center = minus(moved, cross(turned, arm));
            let turned = part.along_axes(turned);
            (0..3).for_each(|k| part.settlement[k] += center[k]);
            (0..3).for_each(|k| part.settlement[3 + k] += turned[k]);
        }
        part
    }

    /// A body's convex pieces in the world; of a surface its triangles.
    fn pieces(body: &Body<Self>) -> Vec<Piece>;

    /// Distance of two bodies that do not overlap, metres; zero where they meet.
    fn distance(a: &Body<Self>, b: &Body<Self>) -> f64 {
        let (origin, unit) = (Self::in_space(Self::place(&a.pose)), a.shape.radius());
        let (own, others) = (Self::pieces(a), Self::pieces(b));
        let each = own.iter().flat_map(|a| others.iter().map(move |b| distance(a, b, origin, unit)));
        each.fold(f64::INFINITY, f64::min)
    }

    /// A vector of the world, z being 0 in the plane.
    fn in_space(vector: Self::Vector) -> [f64; 3];
}

const WORLD_AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Assemble for Polygon {
    const COMPONENTS: &'static [usize] = &[0, 1, 5];

    fn contacts(scene: &Scene) -> Result<ContactSet, SceneError> {
        find_contacts(scene)
    }

    fn unloaded(body: &Body) -> Part {
        Part {
            name: body.name.clone(),
            fixed: body.fixed,
            mass: body.mass(),
            inertia: [body.inertia(); 3],
            axes: WORLD_AXES,
            center: Self::in_space(body.pose.position),
            radius: body.shape.radius(),
            load: [0.0; 6],
            settlement: [0.0; 6],
        }
    }

    fn pieces(body: &Body) -> Vec<Piece> {
        vec![Piece::planar(&body.vertices())]
    }

    fn in_space([x, y]: [f64; 2]) -> [f64; 3] {
        [x, y, 0.0]
    }
}

impl Assemble for Solid {
    const COMPONENTS: &'static [usize] = &[0, 1, 2, 3, 4, 5];

    fn contacts(scene: &SceneOf<Self>) -> Result<ContactSet, SceneError> {
        find_solid_contacts(scene)
    }

    fn unloaded(body: &Body<Self>) -> Part {
        let moments = body.moments();
        Part {
            name: body.name.clone(),
            fixed: body.fixed,
            mass: body.mass(),
            inertia: [0, 1, 2].map(|k| moments[k]),
            axes: body.principal_axes().map(|axis| body.pose.rotate(axis).to_array()),
            center: body.pose.position,
            radius: body.shape.radius(),
            load: [0.0; 6],
            settlement: [0.0; 6],
        }
    }

    fn pieces(body: &Body<Self>) -> Vec<Piece> {
        Piece::of_solid(&body.shape, &body.pose)
    }

    fn distance(a: &Body<Self>, b: &Body<Self>) -> f64 {
        solid_distance(a, b)
    }

    fn in_space(vector: [f64; 3]) -> [f64; 3] {
        vector
    }
}

impl Part {
    /// Force and moment about the centre of mass of a force at a point of the world.
    pub fn wrench(&self, force: [f64; 3], point: [f64; 3]) -> Components {
        self.wrench_at(force, minus(point, self.center))
    }

    /// The same of a force at a point seen from the centre of mass.
    fn wrench_at(&self, force: [f64; 3], arm: [f64; 3]) -> Components {
        let moment = self.along_axes(cross(arm, force));
        [force[0], force[1], force[2], moment[0], moment[1], moment[2]]
    }

    /// A force at a point seen from the centre of mass and a moment beside it, in world axes.
    pub(crate) fn wrench_and_moment(&self, force: [f64; 3], arm: [f64; 3], moment: [f64; 3]) -> Components {
        let [x, y, z] = self.along_axes(moment);
        let beside = [0.0, 0.0, 0.0, x, y, z];
        let at = self.wrench_at(force, arm);
        std::array::from_fn(|k| at[k] + beside[k])
    }

    /// The size of the permanent loads, N: moments count by the force at the radius of gyration that gives them.
    pub fn load_size(&self) -> f64 {
        if self.load == [0.0; 6] {
            return 0.0; // most have none
        }
        let [x, y, z, turning @ ..] = self.load;
        let moments =
            turning.iter().zip(self.inertia).map(|(moment, inertia)| moment.abs() * (self.mass / inertia).sqrt());
        length([x, y, z]) + moments.fold(0.0, f64::max)
    }

    /// A vector of the world along the principal axes.
    pub fn along_axes(&self, vector: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, vector))
    }

    /// The vector of the world with these components along the principal axes.
    pub fn in_world(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| x * self.axes[0][k] + y * self.axes[1][k] + z * self.axes[2][k])
    }

    /// Diagonal of `M^-1`: 1/kg thrice, 1/(kg m^2) thrice.
    pub fn inverse_mass(&self) -> Components {
        let [x, y, z] = self.inertia.map(f64::recip);
        let per_mass = self.mass.recip();
        [per_mass, per_mass, per_mass, x, y, z]
    }
}
