"""Environments for learning: Gymnasium's Env and VectorEnv, and PettingZoo's ParallelEnv.

    import gymnasium, vinerow.gym
    env = gymnasium.make("vinerow/RowFollowing-v0")

Guide: docs/guides/gym.md. Needs the package gymnasium; parallel_env() needs pettingzoo.
"""

from __future__ import annotations

from typing import Any

try:
    import gymnasium as _gymnasium
except ImportError as _missing:
    raise ImportError("vinerow.gym needs the package gymnasium: pip install gymnasium") from _missing

from .environment import Env, VectorEnv
from .tasks import TASKS, TaskDefinition, describe

__all__ = ["Env", "TASKS", "TaskDefinition", "VectorEnv", "describe", "parallel_env"]

for _task in TASKS.values():
    if _task.id not in _gymnasium.registry:
        _gymnasium.register(_task.id, entry_point="vinerow.gym:Env", vector_entry_point="vinerow.gym:VectorEnv",
                            kwargs={"task": _task.task})


def parallel_env(**options: Any) -> Any:
    """A rover and a quadrotor in one vineyard as a PettingZoo ParallelEnv; options as for vinerow.gym.parallel.ParallelEnv."""
    from .parallel import ParallelEnv
    return ParallelEnv(**options)
