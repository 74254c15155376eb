# SPDX-License-Identifier: MIT
"""The Vulkan devices that scenes and pictures may be on."""
from __future__ import annotations

import os
from typing import NamedTuple, NoReturn, Optional, Union

from . import _core as core
from ._common import encoded_text, not_pickled


class DeviceInfo(NamedTuple):
    """A Vulkan device of this machine."""

    #: What `Device` takes.
    number: int
    name: str
    #: "discrete", "integrated", "virtual", "cpu" or "other"
    kind: str
    driver: str
    #: of Vulkan, as "1.3.230"
    api: str


def devices() -> list[DeviceInfo]:
    """The Vulkan devices of this machine. UnsupportedError where there is none, with what to install."""
    return [DeviceInfo(*facts) for facts in core.Device.every()]


class MethodReport(NamedTuple):
    """What a counting method is worth on a device."""

    #: a detector can be made for it
    available: bool
    #: it counted what was known beforehand
    trusted: bool
    #: what was counted and compared, or what is wrong
    text: str


class Device:
    """A Vulkan device, opened: for the `device` of scenes and pictures, which may share it.

    which: its number in `devices()`, a part of its name, or nothing for the best one.
    """

    __slots__ = ("_core",)
    _core: core.Device

    def __init__(self, which: Union[None, int, str] = None) -> None:
        self._core = core.Device.open(encoded_text("" if which is None else str(which), "device"))

    @property
    def info(self) -> DeviceInfo:
        """Which one it is."""
        return DeviceInfo(*self._core.facts)

    @property
    def methods(self) -> dict[str, Optional[str]]:
        """Every counting method: None where the device has it, else why not."""
        return self._core.methods

    @property
    def default_method(self) -> str:
        """The default counting method of `Scene.count`, for projections other than "certified"."""
        return self._core.default_method

    def self_test(self) -> dict[str, MethodReport]:
        """Counts a known number of fragments by every method, and compares the arithmetic of "compute" with the host's,
        bit for bit: whether this driver's answers can be trusted. Some ten milliseconds, and the making of pipelines.
        """
        return {report[0]: MethodReport(*report[1:]) for report in self._core.self_test()}

    def __repr__(self) -> str:
        info = self.info
        return f"<voxtact.Device {info.number} {info.name!r}, {info.kind}, {info.driver}, Vulkan {info.api}>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)


# By process: a device does not live on in the child of a fork.
_best_devices: dict[int, Device] = {}


def best_device() -> Device:
    """Opened once."""
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
