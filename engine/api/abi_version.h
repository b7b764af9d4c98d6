#pragma once
/// Number of the plug-in interface, and the text of the public headers that it stands for. Written
/// by tools/abi_version --update; a test fails where the headers change and this does not.

#define VINEROW_ABI_VERSION 13
#define VINEROW_ABI_HEADERS "4b53e79117ebb8e7"
