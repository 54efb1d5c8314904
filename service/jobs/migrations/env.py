"""Runs the migrations on the connection that :func:`service.jobs.store.database.upgrade` provides."""

from alembic import context

from service.jobs.store.schema import metadata

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=metadata,
    # SQLite cannot alter a column in place; Alembic then copies the table.
    render_as_batch=True,
)
with context.begin_transaction():
    context.run_migrations()
