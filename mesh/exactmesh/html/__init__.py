"""A report as one page that needs no network: the mesh, to be zoomed down to the last bit, and every failing place.

The page is made of the files in this folder; :mod:`exactmesh.html.page` puts them together, and the browser does the
rest. It is reached by :meth:`exactmesh.verify.Report.to_html`.
"""

from exactmesh.html.page import page_of

__all__ = ["page_of"]
