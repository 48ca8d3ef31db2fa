"""The page in the browser: a server on this machine only, its routes, and the files of the page.

:func:`coaxshell.apps.studio.server.serve` runs it, :func:`coaxshell.apps.studio.app.create_app` makes the application.
"""
