"""Compilation of kernels, and when a compiled kernel on disk is still the one of the sources.

`numba` keeps compiled kernels on disk and compiles again when the file of the kernel changes. A kernel
also contains the code of the kernels that it calls and the constants that it reads, which may stand in other files:
after an upgrade in place it would go on with their old code. Here a kernel's sources are its own file and every file
of the project that it imports, directly or through others. Kernels take `njit` from this module.
"""

import re
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from inspect import isfunction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numba
import numba.core.config
from numba.core.caching import InTreeCacheLocator, UserProvidedCacheLocator, UserWideCacheLocator
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher

_OURS = rb"(?:kinematics|synthesis)[\w.]*"
_IMPORT = re.compile(rb"^ *(?:from (%b) import (\([^)]*\)|.*)|import (%b))" % (_OURS, _OURS), re.MULTILINE)


@cache
def _text(source: Path) -> bytes:
    return source.read_bytes()


@cache
def _imports(root: Path, source: Path) -> frozenset[Path]:
    """Files of the project below `root` that `source` imports, packages by their `__init__`."""
    files = set()
    for module, names, whole in _IMPORT.findall(_text(source)):
        place = root.joinpath(*(module or whole).decode().split("."))
        if place.is_dir():
            files.add(place / "__init__.py")
            files.update(place / f"{name.decode()}.py" for name in re.findall(rb"\w+", names))
        else:
            files.add(place.with_suffix(".py"))
    return frozenset(file for file in files if file.is_file())


@cache
def sources(root: Path, source: Path) -> tuple[Path, ...]:
    """`source` and all files of the project that it imports, directly or through others, in the order of their paths.

    `root` is the folder of the top-level packages.
    """
    reached = {source}
    waiting = [source]
    while waiting:
        further = _imports(root, waiting.pop()) - reached
        reached |= further
        waiting.extend(further)
    return tuple(sorted(reached))


@cache
def digest(root: Path, source: Path) -> str:
    """A digest of the text of `sources`: equal where a kernel compiled before is still the one of the sources."""
    return sha256(b"".join(sha256(_text(file)).digest() for file in sources(root, source))).hexdigest()


def _root(source: Path) -> Path:
    """The folder of the top-level package of a source."""
    return next(folder for folder in source.parents if not (folder / "__init__.py").exists())


class _BySources:
    """What a locator of `numba`'s cache says of a kernel's sources."""

    _py_file: str

    def get_source_stamp(self) -> str:
        source = Path(self._py_file).resolve()
        return digest(_root(source), source)


class InStatedFolder(_BySources, UserProvidedCacheLocator):
    """Kernels in the folder that `NUMBA_CACHE_DIR` names, where it is set."""


class BesideSources(_BySources, InTreeCacheLocator):
    """Kernels in the `__pycache__` beside their sources, where that can be written."""


class InCheckout(BesideSources):
    """The same where the sources are a checkout of the project; what is installed is left as it was."""

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> Any:
        """As numba asks; None where this is no place for the kernel."""
        in_checkout = (_root(Path(py_file).resolve()) / "pyproject.toml").exists()
        beside: Any = super()  # numba annotates nothing
        return beside.from_function(py_func, py_file) if in_checkout else None


class OfUser(_BySources, UserWideCacheLocator):
    """Kernels in the user's cache folder, where there is one."""


LOCATORS: tuple[Any, ...] = (InStatedFolder, InCheckout, OfUser, BesideSources)
"""Where kernels may be kept, in the order in which places are tried."""

_LOCATORS = ",".join(f"{__name__}.{locator.__name__}" for locator in LOCATORS)


_Dispatcher: Any = CPUDispatcher


class _Declared(_Dispatcher):
    """A kernel of one declared signature, which is compiled when the kernel is first used, not when it is imported."""

    declared: Any = None
    """The signature as long as it has not been compiled."""

    def _settle(self) -> None:
        if self.declared is not None:
            with global_compiler_lock:
                if self.declared is not None:
                    super().compile(self.declared)
                    self.disable_compile()
                    self.declared = None

    def _compile_for_args(self, *args: Any, **named: Any) -> Any:
        # The dispatcher, which is C, asks here for what to call where it has found no compiled signature.
        if self.declared is None:
            return super()._compile_for_args(*args, **named)
        self._settle()
        return self

    def get_call_template(self, args: Any, kws: Any) -> Any:
        self._settle()
        return super().get_call_template(args, kws)

    def get_function_type(self) -> Any:
        self._settle()
        return super().get_function_type()

    def get_compile_result(self, sig: Any) -> Any:
        self._settle()
        return super().get_compile_result(sig)

    def _reduce_states(self) -> Any:
        self._settle()
        return super()._reduce_states()


def _njit(*signature: Any, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """`numba.njit`, its cache held against all sources of the kernel, and its options all stated.

    What a kernel leaves open, `numba` takes from the kernel that it is compiled for: the same kernel would have other
    code, and answers other digits, wherever another one was compiled first. A multiplication that is fused with an
    addition is no option at all: even of the compiler's own functions, such as the division of complex numbers, one
    version is kept for all kernels of a process, that of the first.
    """
    if options.get("fastmath"):
        raise ValueError("a kernel is compiled by the rules of IEEE 754, as all others are")
    options = {"error_model": "numpy", "fastmath": False, "forceinline": False, **options}
    declared = None if not signature or isfunction(signature[0]) else signature[0]
    compile_kernel = numba.njit(*(signature if declared is None else ()), **options)

    def decorate(function: Callable[..., Any]) -> Any:
        config: Any = numba.core.config
        before = config.CACHE_LOCATOR_CLASSES
        config.CACHE_LOCATOR_CLASSES = _LOCATORS
        try:
            kernel = compile_kernel(function)
        finally:
            config.CACHE_LOCATOR_CLASSES = before
        if declared is not None:
            kernel.__class__ = _Declared
            kernel.declared = declared
        return kernel

    return decorate


if TYPE_CHECKING:
    from numba import njit as njit  # a kernel keeps the annotations of its function
else:
    njit = _njit
