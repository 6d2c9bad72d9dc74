"""The peers, by the names used on the command line."""

from peers import clarabel, daqp, drystone, highs, piqp
from peers.base import Answer, Peer, Run

__all__ = ["PEERS", "Answer", "Peer", "Run"]

PEERS: dict[str, Peer] = {
    "reuse": drystone.Reuse(),
    "reuse-dantzig": drystone.ReuseDantzig(),
    "lcp": drystone.Lcp(),
    "highs-primal": highs.WarmPrimal(),
    "highs-dual": highs.WarmDual(),
    "highs-cold": highs.Cold(),
    "daqp": daqp.Hot(),
    "piqp": piqp.Cold(),
    "clarabel": clarabel.Cold(),
}
"""`reuse` first: the others are compared with it."""
