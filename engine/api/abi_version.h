#pragma once
/// Version of the plug-in interface, and hash of the public headers for which it holds. Written by
/// tools/abi_version --update; a test fails if the headers change and this file does not.

#define VINEROW_ABI_VERSION 34
#define VINEROW_ABI_HEADERS "b9ff14ec68238849"
