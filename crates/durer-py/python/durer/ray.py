"""Ray Data: pictures and clipping of data sets, block by block, errors as a column."""

from __future__ import annotations

from typing import Any

from .batch import clip_batch, render_batch

#: Number of actors, or the smallest and the largest number; ``None`` for one per CPU of the cluster.
Actors = int | tuple[int, int] | None


class _Renderer:
    """A long-lived actor: the module is loaded and its threads are started only once."""

    def __init__(self, options: dict[str, Any]) -> None:
        self.options = options

    def __call__(self, batch: Any) -> Any:
        return render_batch(batch, **self.options)


class _Clipper:
    def __init__(self, mask: Any, options: dict[str, Any]) -> None:
        self.mask, self.options = mask, options

    def __call__(self, batch: Any) -> Any:
        return clip_batch(batch, self.mask, **self.options)


def _mapped(dataset: Any, actor: type, arguments: tuple[Any, ...], batch_size: int, concurrency: Actors) -> Any:
    from ray.data import ActorPoolStrategy

    least, most = concurrency if isinstance(concurrency, tuple) else (concurrency or 1, concurrency)
    return dataset.map_batches(
        actor,
        fn_constructor_args=arguments,
        batch_format="pyarrow",
        batch_size=batch_size,
        num_cpus=1,
        compute=ActorPoolStrategy(min_size=least, max_size=most),
    )


def render(dataset: Any, *, batch_size: int = 32, concurrency: Actors = None, **options: Any) -> Any:
    """Renders each row of a ``ray.data.Dataset``; see ``durer.batch.render_batch`` for its columns."""
    given = ({"threads": 1, **options},)
    return _mapped(dataset, _Renderer, given, batch_size, concurrency)


def clip(dataset: Any, mask: Any, *, batch_size: int = 4096, concurrency: Actors = None, **options: Any) -> Any:
    """Clips the WKB of each row of a ``ray.data.Dataset``; see ``durer.batch.clip_batch``."""
    return _mapped(dataset, _Clipper, (mask, options), batch_size, concurrency)
