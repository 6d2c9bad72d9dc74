//! The complete disassembly graph of a small assembly (Fig. 5).

use super::stability::PlanError;
use crate::{
    check::check_blocks,
    error::SceneError,
    formulate::{Assembly, BlockSet},
};

/// One sub-assembly of the graph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GraphNode {
    /// Scene indices of its movable bodies, ascending.
    pub bodies: Vec<usize>,
    /// Whether it stands.
    pub stands: bool,
}

/// Most movable blocks of a graph that is written out: 4096 nodes.
const MOST_BLOCKS: usize = 12;

/// Every sub-assembly of a scene with the verdict on it, by size.
///
/// # Errors
/// [`SceneError::BadParameter`] for more than 12 movable blocks.
pub fn disassembly_graph(assembly: &Assembly) -> Result<Vec<GraphNode>, PlanError> {
    let blocks = assembly.blocks();
    if blocks > MOST_BLOCKS {
        return Err(SceneError::BadParameter {
            scene: "disassembly graph".into(),
            parameter: "number of movable blocks".into(),
            found: blocks.to_string(),
            expected: format!("at most {MOST_BLOCKS}: the graph has 2^n nodes"),
        }
        .into());
    }
    let mut nodes: Vec<GraphNode> = (0..1usize << blocks)
        .map(|mask| {
            let mut set = BlockSet::empty(blocks);
            (0..blocks).filter(|block| mask >> block & 1 == 1).for_each(|block| set.insert(block));
            GraphNode {
                bodies: set.iter().map(|block| assembly.body_index(block)).collect(),
                stands: check_blocks(assembly, &set).stable,
            }
        })
        .collect();
    nodes.sort_by(|a, b| a.bodies.len().cmp(&b.bodies.len()).then_with(|| a.bodies.cmp(&b.bodies)));
    Ok(nodes)
}
