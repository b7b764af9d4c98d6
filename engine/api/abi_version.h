#pragma once
/// Version of the plug-in interface, and hash of the public headers for which it holds. Written by
/// tools/abi_version --update; a test fails if the headers change and this file does not.

#define VINEROW_ABI_VERSION 32
#define VINEROW_ABI_HEADERS "9bac2797ced39050"
