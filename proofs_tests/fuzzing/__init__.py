"""Coverage-guided fuzzing of everything that reads bytes or anybody's objects.

``python -m proofs_tests.fuzzing [TARGET ...] --minutes M`` lets atheris, which is libFuzzer for Python, change small
valid inputs until they reach new lines, with the interpreted functions. The law is the same for every target: a right
result, or an :class:`exactmesh.ExactMeshError` that names the culprit; no other exception, no warning, no hang, no
crash, no memory on the word of a header; and what was read and is written again reads the same.

Every reader of the library, found by looking for ``open(``, ``read_bytes``, ``loads``, ``loadtxt``, ``literal_eval``
and for public functions that take objects of others, and the target that reaches it:

======================================================= ========================================================
``io.node`` ``io.ele`` ``io.edge`` ``io.neigh``         ``node`` ``ele`` ``edge`` ``neigh`` ``siblings``
``io.poly`` ``io.area`` ``io.csv``                      ``poly`` ``area`` ``csv``
``io.npz``                                              ``npz`` (bytes), ``members`` (arrays in a sound archive)
``io.files`` ``triangle.files``: files beside others    ``siblings``
``geojson``                                             ``geojson`` (bytes), ``features`` (dictionaries)
``triangle.switches``                                   ``switches``
``triangle.dictionary``                                 ``dictionary``
``verify.certificate``                                  ``certificate``; what reports write: ``verify``
``conformance.inputs``: Python on the command line      ``literal``
``adapters.files`` ``adapters.streams``, through meshio ``foreign``
``adapters``: objects                                   ``objects`` ``shapes``
``PSLG`` ``rings``                                      ``pslg`` ``rings``
``verify``                                              ``verify``
======================================================= ========================================================

Not targets: ``certificate_file``, ``verify_file`` and the command, which call these readers with what a path says;
``conformance.channel`` and ``conformance.child`` unpickle what their own process wrote, and what the
caller pickled; ``verify.schema`` reads a file of the package; C libraries that meshio calls read HDF5 and netCDF.
``.v.node`` and ``.v.edge`` are written and never read, but as a ``.node`` and an ``.edge`` file, whose targets get
them among their seeds.
"""
