# SPDX-License-Identifier: MIT
"""Vulkan devices for scenes and pictures."""
from __future__ import annotations

import os
from typing import NamedTuple, NoReturn, Optional, Union

from . import _handles as core
from ._common import encoded_text, not_pickled


class DeviceInfo(NamedTuple):
    """A Vulkan device of this machine."""

    #: Argument of `Device`.
    number: int
    name: str
    #: "discrete", "integrated", "virtual", "cpu" or "other"
    kind: str
    driver: str
    #: Vulkan version, as "1.3.230"
    api: str


def devices() -> list[DeviceInfo]:
    """Returns the Vulkan devices of this machine. UnsupportedError without one; its text names the packages to install.
    """
    return [DeviceInfo(*facts) for facts in core.Device.every()]


class MethodReport(NamedTuple):
    """State of a counting method on a device."""

    #: True: a detector can use it
    available: bool
    #: True: it counted the known number
    trusted: bool
    #: the counts and comparisons, or the failure
    text: str


class Device:
    """An open Vulkan device, for the `device` of scenes and pictures, which may share it.

    which: its index in `devices()`, a part of its name, or None for the best one.
    """

    __slots__ = ("_core",)
    _core: core.Device

    def __init__(self, which: Union[None, int, str] = None) -> None:
        self._core = core.Device.open(encoded_text("" if which is None else str(which), "device"))

    @property
    def info(self) -> DeviceInfo:
        """Facts of the device."""
        return DeviceInfo(*self._core.facts)

    @property
    def methods(self) -> dict[str, Optional[str]]:
        """All counting methods: None if the device supports the method, else the reason."""
        return self._core.methods

    @property
    def default_method(self) -> str:
        """The default counting method of `Scene.count`, for projections other than "certified"."""
        return self._core.default_method

    def self_test(self) -> dict[str, MethodReport]:
        """Counts a known number of fragments by every method, and compares the arithmetic of "compute" with the host's,
        bit for bit, to check this driver. Takes some ten milliseconds, plus pipeline creation."""
        return {report[0]: MethodReport(*report[1:]) for report in self._core.self_test()}

    def __repr__(self) -> str:
        info = self.info
        return f"<voxtact.Device {info.number} {info.name!r}, {info.kind}, {info.driver}, Vulkan {info.api}>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)


# One per process: a device does not survive a fork.
_best_devices: dict[int, Device] = {}


def best_device() -> Device:
    """Opens the best device, once per process."""
    process = os.getpid()
    if process not in _best_devices:
        _best_devices[process] = Device()
    return _best_devices[process]


def opened(device: Union[None, bool, int, str, Device]) -> Optional[Device]:
    if device is None or device is False:
        return None
    if isinstance(device, Device):
        return device
    return best_device() if device is True else Device(device)
