"""A sweep's dataset as a file: netCDF or Zarr, by its suffix, whole or not at all."""

from __future__ import annotations

import io
import os
import shutil
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from zygopin.archive import DAMAGE
from zygopin.errors import FileError, MissingExtraError
from zygopin.exchange import put
from zygopin.files import as_path, check_folder, write_bytes
from zygopin.sweep_dataset import Dataset, xarray

NEEDED = {".nc": "h5netcdf", ".zarr": "zarr"}
"""What writes each kind of file, by suffix; xarray's names of engines too."""

ZARR_FORMAT = 2
"""Zarr's format: its third version has no settled type for text."""


def check_output(path: Path | str) -> Path:
    """An output is of a kind that can be written, and replaces nothing else.

    Args:
        path: The file, or the Zarr folder.

    Returns:
        The path.

    Raises:
        FileError: Another suffix, or a folder that holds no Zarr dataset.
        MissingExtraError: What writes such a file is not installed.
    """
    target = as_path(path)
    if target.suffix not in NEEDED:
        remedy = "end its name with .nc for netCDF or .zarr for Zarr"
        raise FileError(path, "is of no kind that a sweep is saved as", remedy)
    if find_spec(NEEDED[target.suffix]) is None:
        raise MissingExtraError(NEEDED[target.suffix], "sweep")
    wanted = _is_zarr(target) if target.suffix == ".zarr" else target.is_file()
    if target.exists() and not wanted:
        problem = f"cannot be replaced: it is no {target.suffix} dataset"
        raise FileError(path, problem, "name another file")
    check_folder(target.parent)
    return target


def save_dataset(dataset: Dataset, path: Path | str) -> Path:
    """Write a dataset beside its place, then rename it into it.

    Args:
        dataset: A sweep's dataset.
        path: The file, or the Zarr folder; missing parent folders are created.

    Returns:
        The path.

    Raises:
        FileError: It cannot be written.
        MissingExtraError: What writes such a file is not installed.
    """
    if check_output(path).suffix == ".nc":
        return write_bytes(path, _netcdf(dataset))
    target = Path(os.path.realpath(path))
    part = target.with_name(f".{os.urandom(8).hex()}.zarr")
    try:
        for name, content in _zarr(dataset).items():
            (part / name).parent.mkdir(parents=True, exist_ok=True)
            (part / name).write_bytes(content)
        put(part, target)
    except OSError as error:
        remedy = "name a file in a folder that can be written"
        problem = f"cannot be written: {error.strerror or error}"
        raise FileError(path, problem, remedy) from error
    finally:
        try:
            shutil.rmtree(part, ignore_errors=True)
        except BaseException:  # interrupted
            shutil.rmtree(part, ignore_errors=True)
            raise
    return Path(path)


def saved_dataset(path: Path | str, digest: str) -> Dataset | None:
    """A finished sweep, if it answers the same question.

    Args:
        path: The file, or the Zarr folder.
        digest: The digest that its attributes must have.

    Returns:
        The dataset, in memory; None where there is no such file.
    """
    target = Path(path)
    if not target.exists():
        return None
    try:
        dataset = load_dataset(target)
    except FileError:
        return None
    return dataset if dataset.attrs.get("digest") == digest else None


def load_dataset(path: Path | str) -> Dataset:
    """Read a sweep's dataset into memory.

    Args:
        path: The file, or the Zarr folder.

    Returns:
        The dataset.

    Raises:
        FileError: It cannot be read.
    """
    target = Path(path)
    try:
        engine = NEEDED[target.suffix]
        options = {"consolidated": True} if engine == "zarr" else {}
        with xarray.open_dataset(target, engine=engine, **options) as dataset:  # type: ignore[arg-type]
            loaded: Dataset = dataset.load()
    except (OSError, *DAMAGE) as error:
        remedy = "name a file that `sweep` wrote"
        raise FileError(path, f"is no dataset: {error}", remedy) from error
    return loaded


def _netcdf(dataset: Dataset) -> bytes:
    """A dataset as a netCDF file, made in memory: HDF5 crashes where a disk is full."""
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    memory = io.BytesIO()
    with h5netcdf.File(memory, "w") as file:
        dataset.dump_to_store(H5NetCDFStore(file))
    return memory.getvalue()


def _zarr(dataset: Dataset) -> dict[str, bytes]:
    """A dataset as the files of a Zarr folder: Zarr's threads outlive interruptions.

    Made in memory, where what they write late is in nobody's way.
    """
    files: dict[str, Any] = {}
    dataset.to_zarr(files, mode="w", zarr_format=ZARR_FORMAT, consolidated=True)
    return {
        name: content.to_bytes() if hasattr(content, "to_bytes") else content
        for name, content in files.items()  # buffers, or bytes before Zarr 3
    }


def _is_zarr(path: Path) -> bool:
    """Whether a folder holds a Zarr dataset."""
    return any((path / name).is_file() for name in (".zgroup", "zarr.json"))
