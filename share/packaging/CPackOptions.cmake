# Read by cpack itself: the date of all members of the archives, and no line before the packages' own descriptions.
set(ENV{SOURCE_DATE_EPOCH} ${CPACK_VIWO_EPOCH})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
