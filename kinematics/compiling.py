"""Compilation of kernels, with a disk cache that notices changes in imported files.

`numba` caches compiled kernels on disk and recompiles a kernel when its own file changes. But a kernel also contains
the code of the kernels that it calls and the constants that it reads, which may be defined in other files: after an
upgrade in place it would keep running their old code. Here the sources of a kernel are its own file and every project
file that it imports, directly or indirectly. All kernels take `njit` from this module.
"""

import re
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from inspect import isfunction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict

import numba
import numba.core.config
from numba.core.caching import (
    IndexDataCacheFile,
    InTreeCacheLocator,
    UserProvidedCacheLocator,
    UserWideCacheLocator,
)
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher


class KernelOptions(TypedDict, total=False):
    """Options of `njit` that several kernels share."""

    cache: bool
    nogil: bool
    error_model: Literal["python", "numpy"]
    forceinline: bool


_PROJECT_MODULES = rb"(?:kinematics|synthesis)[\w.]*"
_IMPORT_PATTERN = re.compile(
    rb"^ *(?:from (%b) import (\([^)]*\)|.*)|import (%b))" % (_PROJECT_MODULES, _PROJECT_MODULES), re.MULTILINE
)


@cache
def _read_source(source: Path) -> bytes:
    return source.read_bytes()


@cache
def _find_imports(root: Path, source: Path) -> frozenset[Path]:
    """Return the project files below `root` that `source` imports; packages are represented by `__init__`."""
    files = set()
    for module, names, whole in _IMPORT_PATTERN.findall(_read_source(source)):
        place = root.joinpath(*(module or whole).decode().split("."))
        if place.is_dir():
            files.add(place / "__init__.py")
            # A name imported from a package may be a submodule; names that are no file are dropped below.
            files.update(place / f"{name.decode()}.py" for name in re.findall(rb"\w+", names))
        else:
            files.add(place.with_suffix(".py"))
    return frozenset(file for file in files if file.is_file())


@cache
def find_sources(root: Path, source: Path) -> tuple[Path, ...]:
    """Return `source` and all project files that it imports, directly or indirectly, sorted by path.

    `root` is the folder that contains the top-level packages.
    """
    reached = {source}
    waiting = [source]
    while waiting:
        further = _find_imports(root, waiting.pop()) - reached
        reached |= further
        waiting.extend(further)
    return tuple(sorted(reached))


@cache
def compute_digest(root: Path, source: Path) -> str:
    """Return a digest of all sources of `source`; it changes whenever a kernel has to be compiled again."""
    return sha256(b"".join(sha256(_read_source(file)).digest() for file in find_sources(root, source))).hexdigest()


def _find_root(source: Path) -> Path:
    """Return the folder that contains the top-level package of a source file."""
    return next(folder for folder in source.parents if not (folder / "__init__.py").exists())


class _SourceStampMixin:
    """Mixin for a cache locator of `numba`: stamps a kernel with the digest of all its sources."""

    _py_file: str

    def get_source_stamp(self) -> str:
        source = Path(self._py_file).resolve()
        return compute_digest(_find_root(source), source)


class EnvironmentFolderLocator(_SourceStampMixin, UserProvidedCacheLocator):
    """Locator of the folder named by `NUMBA_CACHE_DIR`, if that is set."""


class SourceFolderLocator(_SourceStampMixin, InTreeCacheLocator):
    """Locator of the `__pycache__` next to the sources, if that is writable."""


class CheckoutLocator(SourceFolderLocator):
    """Locator of `__pycache__` in a checkout of the project; installed packages are left untouched."""

    @classmethod
    def from_function(cls, py_func: Callable[..., object], py_file: str) -> object:
        """Return the locator for a kernel (the hook that numba calls), or None outside a checkout."""
        in_checkout = (_find_root(Path(py_file).resolve()) / "pyproject.toml").exists()
        locator: Any = super()  # numba has no annotations
        return locator.from_function(py_func, py_file) if in_checkout else None


class UserFolderLocator(_SourceStampMixin, UserWideCacheLocator):
    """Locator of the user's cache folder, if there is one."""


LOCATORS: tuple[Any, ...] = (EnvironmentFolderLocator, CheckoutLocator, UserFolderLocator, SourceFolderLocator)
"""Cache locators in the order in which they are tried."""

_LOCATORS = ",".join(f"{__name__}.{locator.__name__}" for locator in LOCATORS)


_CacheFile: Any = IndexDataCacheFile


class _UpgradableCacheFile(_CacheFile):
    """Index of compiled kernels that counts as empty if an earlier version wrote types that no longer exist."""

    def _load_index(self) -> object:
        # numba unpickles the argument types of all entries before it compares the stamp of the sources, so a renamed
        # class would end the process after an upgrade in place instead of compiling the kernel again.
        try:
            return super()._load_index()
        except (AttributeError, ImportError):
            return {}


_Dispatcher: Any = CPUDispatcher  # the stubs of numba omit the methods that are overridden here


class _LazyKernel(_Dispatcher):
    """A kernel of one declared signature that is compiled at its first use instead of at import."""

    declared: object = None
    """The declared signature until it has been compiled, then None."""

    def _settle(self) -> None:
        if self.declared is not None:
            # Check again under the lock: another thread may have compiled it meanwhile.
            with global_compiler_lock:
                if self.declared is not None:
                    super().compile(self.declared)
                    # Other argument types must fail instead of compiling a second version with other digits.
                    self.disable_compile()
                    self.declared = None

    def _compile_for_args(self, *args: object, **named: object) -> object:
        # The C dispatcher calls this when it finds no compiled signature for the arguments.
        if self.declared is None:
            return super()._compile_for_args(*args, **named)
        self._settle()
        return self

    def get_call_template(self, args: object, kws: object) -> object:
        self._settle()
        return super().get_call_template(args, kws)

    def get_function_type(self) -> object:
        self._settle()
        return super().get_function_type()

    def get_compile_result(self, sig: object) -> object:
        self._settle()
        return super().get_compile_result(sig)

    def _reduce_states(self) -> object:
        self._settle()
        return super()._reduce_states()


def _njit(*signature: Any, **options: Any) -> Callable[[Callable[..., object]], object]:
    """Wrap `numba.njit`: check its cache against all sources of the kernel and set every option explicitly.

    An option that a callee leaves open is inherited from the kernel for which it is first compiled, so results would
    differ in the last digits with the order of compilation. Fused multiply-add is not available as an option at all:
    even the compiler's own functions, such as complex division, are compiled once per process, with the options of
    the first kernel that needs them.
    """
    if options.get("fastmath"):
        raise ValueError("a kernel is compiled by the rules of IEEE 754, as all others are")
    options = {"error_model": "numpy", "fastmath": False, "forceinline": False, **options}
    declared = None if not signature or isfunction(signature[0]) else signature[0]
    compile_kernel = numba.njit(*(signature if declared is None else ()), **options)

    def decorate(function: Callable[..., object]) -> object:
        config: Any = numba.core.config
        before = config.CACHE_LOCATOR_CLASSES
        config.CACHE_LOCATOR_CLASSES = _LOCATORS
        try:
            kernel = compile_kernel(function)
        finally:
            config.CACHE_LOCATOR_CLASSES = before
        if options.get("cache"):
            kernel._cache._cache_file.__class__ = _UpgradableCacheFile
        if declared is not None:
            kernel.__class__ = _LazyKernel
            kernel.declared = declared
        return kernel

    return decorate


if TYPE_CHECKING:
    from numba import njit as njit  # a kernel keeps the annotations of its function
else:
    njit = _njit
