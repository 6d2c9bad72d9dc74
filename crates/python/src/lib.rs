//! The Python extension module `drystone._core`: conversions only. The public names live in `python/drystone`.

mod arrays;
mod contact;
mod contact_forces;
mod coordinates;
mod errors;
mod forces;
mod guard;
mod lcp;
mod lcp_solver;
mod limit;
mod loads;
mod margin;
mod plan;
mod recording;
mod run;
mod scene;
mod settle;
mod strong;
mod structure;
mod verdict;
mod watch;
mod world;

use pyo3::prelude::*;

// Its classes are frozen, or locked while they are used (`guard`): Pythons without a global lock need none for them.
#[pymodule(gil_used = false)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", version())?;
    errors::add_to(module)?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<scene::Body>()?;
    module.add_class::<scene::Solid>()?;
    module.add_class::<scene::Contact>()?;
    module.add_class::<contact_forces::ContactForce>()?;
    module.add_class::<contact_forces::ContactForces>()?;
    module.add_class::<contact_forces::Forces>()?;
    module.add_class::<verdict::Verdict>()?;
    module.add_class::<limit::Limit>()?;
    module.add_class::<limit::LimitEnd>()?;
    module.add_class::<settle::Settled>()?;
    module.add_class::<strong::Strong>()?;
    module.add_class::<strong::Escape>()?;
    module.add_class::<margin::Margin>()?;
    module.add_class::<plan::TestRecord>()?;
    module.add_class::<plan::Plan>()?;
    module.add_class::<plan::Generators>()?;
    module.add_class::<structure::Structure>()?;
    module.add_class::<recording::Recording>()?;
    module.add_class::<recording::Replay>()?;
    module.add_class::<forces::StructureForces>()?;
    module.add_class::<world::World>()?;
    module.add_class::<run::StepRecord>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<lcp::LcpSolution>()?;
    module.add_class::<lcp_solver::LcpSolver>()?;
    module.add_class::<contact::ContactSolution>()?;
    module.add_class::<lcp_solver::LcpSnapshot>()?;
    module.add_function(wrap_pyfunction!(scene::catalogue, module)?)?;
    module.add_function(wrap_pyfunction!(limit::limit, module)?)?;
    module.add_function(wrap_pyfunction!(limit::load_cases, module)?)?;
    module.add_function(wrap_pyfunction!(strong::strong, module)?)?;
    module.add_function(wrap_pyfunction!(margin::margin, module)?)?;
    module.add_function(wrap_pyfunction!(margin::least_friction, module)?)?;
    module.add_function(wrap_pyfunction!(loads::add_load, module)?)?;
    module.add_function(wrap_pyfunction!(loads::add_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(loads::set_friction, module)?)?;
    module.add_function(wrap_pyfunction!(loads::with_gravity, module)?)?;
    module.add_function(wrap_pyfunction!(loads::loads, module)?)?;
    module.add_function(wrap_pyfunction!(loads::pair_frictions, module)?)?;
    module.add_function(wrap_pyfunction!(settle::add_settlement, module)?)?;
    module.add_function(wrap_pyfunction!(settle::settlements, module)?)?;
    module.add_function(wrap_pyfunction!(settle::without_settlements, module)?)?;
    module.add_function(wrap_pyfunction!(settle::settle, module)?)?;
    module.add_function(wrap_pyfunction!(verdict::check, module)?)?;
    module.add_function(wrap_pyfunction!(plan::generators, module)?)?;
    module.add_function(wrap_pyfunction!(plan::plan, module)?)?;
    module.add_function(wrap_pyfunction!(forces::forces_along, module)?)?;
    module.add_function(wrap_pyfunction!(plan::disassembly_graph, module)?)?;
    module.add_function(wrap_pyfunction!(lcp::lcp_solve, module)?)?;
    module.add_function(wrap_pyfunction!(contact::contact_solve, module)?)?;
    Ok(())
}

/// The version as Python writes it: Cargo's `0.2.0-dev` is `0.2.0.dev0` there.
fn version() -> String {
    env!("CARGO_PKG_VERSION").replace("-dev", ".dev0")
}
