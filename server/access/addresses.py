"""Where a request comes from, as far as limits count it."""

from __future__ import annotations

import ipaddress

NETWORK_BITS = 64
"""Of an IPv6 address; whoever has one of them has the whole network of it."""


def site_of(address: str) -> str:
    """Equal for addresses that one person has at will."""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if found.version == 4:
        return str(found)
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ipaddress.ip_network((found, NETWORK_BITS), strict=False))


def is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
