// A library that is no plugin.
extern "C" int fmbpcTestNothing() { return 0; }
