"""How notebooks are run for the site: their kernels talk in cipher, which newer ones ask for.

See https://nbconvert.readthedocs.io/en/latest/config_options.html.
"""

import zmq
from jupyter_client.manager import KernelManager

if KernelManager.class_traits().get("transport_encryption") and zmq.has("curve"):
    c.KernelManager.transport_encryption = "auto"  # noqa: F821 (nbconvert gives c)
