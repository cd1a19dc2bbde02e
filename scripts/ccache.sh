# To be sourced, with top=FOLDER of the checkout: cmake that is configured afterwards compiles through ccache, where it is installed. All
# checkouts share what was compiled; a header that is newer than the compilation (a generated message) is looked at, not its date.
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$top CCACHE_NOHASHDIR=1 \
    CCACHE_SLOPPINESS=time_macros,include_file_mtime,include_file_ctime
fi
