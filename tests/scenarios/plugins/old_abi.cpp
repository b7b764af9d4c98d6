/// A library that says it was built for another ABI.

extern "C" const char* vinerow_plugin_abi() {
  return "vinerow-abi-0-cxxabi-1000";
}
extern "C" void vinerow_plugin_register(void*) {}
